// SPDX-License-Identifier: BSD-3-Clause
#include "prf_core/table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <prf_core/quoted.hpp>
#include <prf_core/readable_file.hpp>
#include <stdexcept>
#include <utility>

namespace prf_core {
namespace {

constexpr std::string_view kUtf8Mark = "\xef\xbb\xbf";
constexpr std::size_t kLongestShown = 60;  // characters of a cell or a header in a message

std::string_view trimmed(std::string_view text) {
  const char* const blanks = " \t\r";
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string shown(std::string_view text) {
  return quoted(std::string(text.substr(0, kLongestShown)));
}

bool is_utf16(std::string_view text) {
  return text.size() >= 2 && (text.substr(0, 2) == "\xff\xfe" || text.substr(0, 2) == "\xfe\xff");
}

char separator_of(std::string_view header) {
  for (const char candidate : {';', '\t'}) {
    if (header.find(candidate) != std::string_view::npos) return candidate;
  }
  return ',';
}

}  // namespace

std::ifstream open_table(const std::string& path) {
  require_readable_file(path);
  return std::ifstream(path, std::ios::binary);
}

TableReader::TableReader(std::istream& in, std::string name, OnComment on_comment)
    : in_(in), name_(std::move(name)), on_comment_(std::move(on_comment)) {}

// A line without its end: LF, CR LF or CR.
bool TableReader::next_line() {
  text_.clear();
  std::streambuf* buffer = in_.rdbuf();
  constexpr int kEnd = std::char_traits<char>::eof();
  int character = buffer->sbumpc();
  if (character == kEnd) {
    if (in_.bad()) throw std::invalid_argument(name_ + ": cannot be read to its end");
    return false;
  }
  for (; character != kEnd && character != '\n' && character != '\r';
       character = buffer->sbumpc()) {
    text_.push_back(static_cast<char>(character));
  }
  if (character == '\r' && buffer->sgetc() == '\n') buffer->sbumpc();
  ++line_;
  if (line_ > 1) return true;
  if (is_utf16(text_)) {
    throw std::invalid_argument(name_ + ": is UTF-16, must be UTF-8 or plain ASCII");
  }
  if (text_.rfind(kUtf8Mark, 0) == 0) text_.erase(0, kUtf8Mark.size());
  return true;
}

bool TableReader::next() {
  while (next_line()) {
    const std::string_view text = trimmed(text_);
    if (text.empty()) continue;
    if (text.front() == '#') {
      if (on_comment_) on_comment_(trimmed(text.substr(1)));
      continue;
    }
    if (separator_ == '\0') separator_ = separator_of(text);
    split();
    return true;
  }
  return false;
}

// Within quotation marks a separator is text, and two marks are one.
void TableReader::split() {
  cells_.clear();
  std::string cell;
  bool is_quoted = false;
  const auto take = [&] {
    cells_.emplace_back(trimmed(cell));
    cell.clear();
  };
  for (std::size_t i = 0; i < text_.size(); ++i) {
    const char character = text_[i];
    if (character == '"' && is_quoted && i + 1 < text_.size() && text_[i + 1] == '"') {
      cell.push_back(text_[++i]);
    } else if (character == '"' && (is_quoted || trimmed(cell).empty())) {
      is_quoted = !is_quoted;
    } else if (character == separator_ && !is_quoted) {
      take();
    } else {
      cell.push_back(character);
    }
  }
  take();
}

void TableReader::read_header(const std::string& wanted) {
  if (!next()) throw std::invalid_argument(name_ + ": is empty, must have the header " + wanted);
  columns_ = cells_;
}

std::optional<std::size_t> TableReader::find(const std::string& column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  if (found == columns_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns_.begin());
}

std::size_t TableReader::column(const std::string& name) const {
  if (const auto found = find(name)) return *found;
  std::string there;
  for (const std::string& column : columns_) there += (there.empty() ? "" : ", ") + column;
  throw std::invalid_argument(name_ + ": no column " + name + ", there are " + shown(there));
}

std::optional<double> TableReader::value(std::size_t cell) const {
  if (cell >= cells_.size()) return std::nullopt;
  std::string text = cells_[cell];
  if (separator_ != ',' && text.find('.') == std::string::npos) {
    const auto mark = text.find(',');
    if (mark != std::string::npos) text[mark] = '.';
  }
  const char* const begin = text.data() + (text.rfind('+', 0) == 0 ? 1 : 0);
  const char* const end = text.data() + text.size();
  double number = 0.0;
  const auto [stopped, error] = std::from_chars(begin, end, number);
  if (error != std::errc() || stopped != end || !std::isfinite(number)) return std::nullopt;
  return number;
}

double TableReader::number(std::size_t cell) const {
  if (cell >= cells_.size()) {
    refuse(std::to_string(cells_.size()) + " values, must be " + std::to_string(columns_.size()));
  }
  if (const auto found = value(cell)) return *found;
  refuse((cell < columns_.size() ? columns_[cell] : "a cell") + " = " + shown(cells_[cell]) +
         ", must be a finite number");
}

void TableReader::refuse(const std::string& what) const {
  throw std::invalid_argument(name_ + ", line " + std::to_string(line_) + ": " + what);
}

}  // namespace prf_core
