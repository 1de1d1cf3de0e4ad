#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What the checks share: which files there are, and how a finding is told.

Usage from a shell: files.py python|shell prints those files, with scripts that have no extension."""
import pathlib
import sys

REPO = pathlib.Path(__file__).resolve().parents[2]
_NOT_OURS = {'__pycache__', 'node_modules'}


def walk(folder):
    """All files of a folder, sorted; hidden ones and what Python leaves behind excepted."""
    for path in sorted(folder.iterdir()):
        if path.name.startswith('.') or path.name in _NOT_OURS:
            continue
        if path.is_dir():
            yield from walk(path)
        elif path.suffix != '.pyc':
            yield path


def all_files():
    """Files of src, scripts and docs, and those of the repository's root."""
    for folder in ('src', 'scripts', 'docs'):
        yield from walk(REPO / folder)
    yield from sorted(path for path in REPO.iterdir() if path.is_file() and not path.is_symlink() and
                      path.suffix in ('', '.md', '.txt', '.cff', '.toml', '.yaml'))


def relative(path):
    return str(path.relative_to(REPO))


def package_of(path):
    parts = path.relative_to(REPO).parts
    return parts[1] if parts[0] == 'src' and len(parts) > 2 else None


def packages():
    return sorted(path.parent.name for path in REPO.glob('src/*/package.xml'))


def text(path):
    try:
        return path.read_text(encoding='utf-8')
    except UnicodeDecodeError:
        return ''  # a picture


def _first_line(path):
    with path.open('rb') as stream:
        return stream.readline(200)


def is_cpp(path):
    return path.suffix in ('.cpp', '.hpp')


def is_python(path):
    return path.suffix == '.py' or (not path.suffix and b'python' in _first_line(path)[:30])


def is_shell(path):
    return path.suffix in ('.sh', '.bash') or (not path.suffix and _first_line(path).startswith(b'#!')
                                               and b'bash' in _first_line(path))


def report(rule, findings):
    """Prints the findings below the rule that they break; returns how many there are."""
    if findings:
        print(f'{rule}:', *(f'  {finding}' for finding in findings), sep='\n', file=sys.stderr)
    return len(findings)


def finish(*counts):
    sys.exit(1 if sum(counts) else 0)


if __name__ == '__main__':
    wanted = {'python': is_python, 'shell': is_shell}[sys.argv[1]]
    print(*(relative(path) for path in all_files() if wanted(path)), sep='\n')
