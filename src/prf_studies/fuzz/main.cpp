// SPDX-License-Identifier: BSD-3-Clause
// The entry points of libFuzzer: runs the target that FUZZ_TARGET names, with every other argument
// as libFuzzer takes it. FUZZ_TARGET=list prints the targets.
#include <console_bridge/console.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <new>

#include "fuzz_target.hpp"

namespace {

bool limited = false;
constexpr std::size_t kLimit = 1 << 20;

std::map<std::string, fuzz::Run>& targets() {
  static std::map<std::string, fuzz::Run> all;
  return all;
}

fuzz::Run chosen = nullptr;

}  // namespace

void* operator new(std::size_t size) {
  if (limited && size > kLimit) throw std::bad_alloc();
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace fuzz {

AllocationLimit::AllocationLimit() { limited = true; }
AllocationLimit::~AllocationLimit() { limited = false; }

Target::Target(const char* name, Run run) { targets()[name] = run; }

void for_each_message(Bytes bytes, const std::function<void(int, Bytes)>& handle) {
  while (bytes.size() >= 3) {
    const int kind = bytes.byte();
    const std::size_t low = bytes.byte();
    handle(kind, bytes.part(low + 256u * bytes.byte()));
  }
}

std::string file_with(const Bytes& bytes, const std::string& ending) {
  static const auto folder = std::filesystem::temp_directory_path();
  const std::string path = folder / ("fuzz_" + std::to_string(getpid()) + ending);
  std::ofstream(path, std::ios::binary) << bytes.text();
  return path;
}

bool accepts(const std::function<void()>& use) {
  try {
    use();
    return true;
  } catch (const std::invalid_argument& refusal) {
    const std::string text = refusal.what();
    expect(!text.empty() && text.size() < 4000, "a refusal says why, in a few words");
    return false;
  }
}

}  // namespace fuzz

// Libraries find either operator new, that of the sanitizer or the one above.
extern "C" const char* __asan_default_options() { return "alloc_dealloc_mismatch=0"; }

// urdfdom's links point at each other: a description with a loop is never freed.
extern "C" const char* __lsan_default_suppressions() { return "leak:urdf::parseURDF"; }

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  console_bridge::noOutputHandler();
  const char* const name = std::getenv("FUZZ_TARGET");
  const auto found = targets().find(name == nullptr ? "" : name);
  if (found != targets().end()) {
    chosen = found->second;
    return 0;
  }
  for (const auto& [known, run] : targets()) std::printf("%s\n", known.c_str());
  std::exit(name != nullptr && std::string_view(name) == "list" ? 0 : 2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  chosen(fuzz::Bytes(data, size));
  return 0;
}
