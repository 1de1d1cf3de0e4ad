// SPDX-License-Identifier: BSD-3-Clause
// Tables of numbers in text files, as recorders, spreadsheets and this project write them: one
// header line with the columns' names, then rows. One reader for all of them, so that each takes
// the same dialects:
//   - cells parted by commas, semicolons or tabs: the first of ; tab , that the header has
//   - where it is not the comma, a comma in a number is the decimal mark
//   - line ends LF, CR LF or CR; a byte order mark of UTF-8; blanks and quotation marks about cells
//   - empty lines are skipped, lines that begin with # are comments
// UTF-16 is refused by name.
#pragma once

#include <cstddef>
#include <fstream>
#include <functional>
#include <istream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace prf_core {

// Throws std::invalid_argument as require_readable_file() does.
[[nodiscard]] std::ifstream open_table(const std::string& path);

class TableReader {
 public:
  using OnComment = std::function<void(std::string_view)>;  // what follows the #, trimmed

  // `name` is the file's, for messages. The stream must outlive the reader.
  TableReader(std::istream& in, std::string name, OnComment on_comment = {});

  // Goes on to the next line with cells, the first of which is the header; false at the end.
  // Throws std::invalid_argument when the stream breaks.
  bool next();

  // next() for the header. Throws std::invalid_argument for an empty file, naming `wanted`.
  void read_header(const std::string& wanted);

  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }
  [[nodiscard]] std::optional<std::size_t> find(const std::string& column) const;
  // Throws std::invalid_argument with the columns that there are.
  [[nodiscard]] std::size_t column(const std::string& name) const;

  // Of the line that next() stopped at.
  [[nodiscard]] const std::vector<std::string>& cells() const { return cells_; }
  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] std::size_t line() const { return line_; }  // from 1

  // A finite number, or nothing.
  [[nodiscard]] std::optional<double> value(std::size_t cell) const;
  // Throws std::invalid_argument with file, line, column and text for all else.
  [[nodiscard]] double number(std::size_t cell) const;

  [[noreturn]] void refuse(const std::string& what) const;  // with file and line

 private:
  bool next_line();
  void split();

  std::istream& in_;
  std::string name_;
  OnComment on_comment_;
  char separator_ = '\0';  // known from the header on
  std::size_t line_ = 0;
  std::string text_;
  std::vector<std::string> cells_;
  std::vector<std::string> columns_;
};

}  // namespace prf_core
