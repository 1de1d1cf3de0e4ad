// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "prf_core/table.hpp"

namespace py = pybind11;

namespace {

// {name: list of the cells of that column}, as numbers or as text.
py::dict read_table(const std::string& path, const std::vector<std::string>& numbers,
                    const std::vector<std::string>& texts) {
  std::ifstream file = prf_core::open_table(path);
  prf_core::TableReader reader(file, path);
  std::string wanted;
  for (const auto* names : {&numbers, &texts}) {
    for (const std::string& name : *names) wanted += (wanted.empty() ? "" : ",") + name;
  }
  reader.read_header(wanted);
  std::vector<std::size_t> number_at, text_at;
  for (const std::string& name : numbers) number_at.push_back(reader.column(name));
  for (const std::string& name : texts) text_at.push_back(reader.column(name));
  std::vector<std::vector<double>> values(numbers.size());
  std::vector<std::vector<std::string>> words(texts.size());
  while (reader.next()) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      values[i].push_back(reader.number(number_at[i]));
    }
    for (std::size_t i = 0; i < texts.size(); ++i) {
      if (text_at[i] >= reader.cells().size()) reader.refuse("has no " + texts[i]);
      words[i].push_back(reader.cells()[text_at[i]]);
    }
  }
  py::dict table;
  for (std::size_t i = 0; i < numbers.size(); ++i) table[py::str(numbers[i])] = values[i];
  for (std::size_t i = 0; i < texts.size(); ++i) table[py::str(texts[i])] = words[i];
  return table;
}

}  // namespace

PYBIND11_MODULE(prf_core, module) {
  module.doc() = "The reader of tables of prf_core, see prf_core/table.hpp.";
  module.def("read_table", &read_table, py::arg("path"), py::arg("numbers"),
             py::arg("texts") = std::vector<std::string>(),
             "{name: list} of the named columns: those in `numbers` as floats, those in `texts` as "
             "str. Other columns are not looked at. Raises ValueError with file, line, column and "
             "what is wanted.");
}
