// SPDX-License-Identifier: BSD-3-Clause
#include "prf_core/table.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "refusal.hpp"

namespace prf_core {
namespace {

// Time and x of every row.
std::vector<std::vector<double>> read(const std::string& text) {
  std::istringstream stream(text);
  TableReader reader(stream, "table");
  reader.read_header("t,x");
  const std::size_t t = reader.column("t"), x = reader.column("x");
  std::vector<std::vector<double>> rows;
  while (reader.next()) rows.push_back({reader.number(t), reader.number(x)});
  return rows;
}

const std::vector<std::vector<double>> kRows{{0.5, -1.25}, {1.5, 3e-4}};

TEST(Table, ReadsTheDialectsOfRecordersAndSpreadsheets) {
  EXPECT_EQ(read("t,x\n0.5,-1.25\n1.5,3e-4\n"), kRows);
  EXPECT_EQ(read("t,x\r\n0.5,-1.25\r\n1.5,3e-4\r\n"), kRows) << "Windows";
  EXPECT_EQ(read("t,x\r0.5,-1.25\r1.5,3e-4"), kRows) << "old Macintosh, no end at the end";
  EXPECT_EQ(read("\xef\xbb\xbft,x\n0.5,-1.25\n1.5,3e-4\n"), kRows) << "byte order mark";
  EXPECT_EQ(read("t;x\n0.5;-1.25\n1.5;3e-4\n"), kRows) << "semicolons";
  EXPECT_EQ(read("t;x\n0,5;-1,25\n1,5;3e-4\n"), kRows) << "decimal commas";
  EXPECT_EQ(read("t\tx\n0,5\t-1.25\n1.5\t3e-4\n"), kRows) << "tabs";
  EXPECT_EQ(read(" t , x \n 0.5 , -1.25 \n 1.5 , +3e-4 \n"), kRows) << "blanks, a plus";
  EXPECT_EQ(read("\"t\",\"x\"\n\"0.5\",-1.25\n1.5,\"3e-4\"\n"), kRows) << "quotation marks";
  EXPECT_EQ(read("a,x,b,t\n#\n\n,-1.25,\"say \"\"a, b\"\"\",0.5\n\n9,3e-4,,1.5\n"), kRows)
      << "other columns, any order";
}

TEST(Table, HandsOutCommentsAndLines) {
  std::vector<std::string> comments;
  std::istringstream stream("# frame: arm \r\nt,x\r\n#end\r\n1,2\r\n");
  TableReader reader(stream, "table",
                     [&](std::string_view comment) { comments.emplace_back(comment); });
  reader.read_header("t,x");
  ASSERT_TRUE(reader.next());
  EXPECT_EQ(reader.line(), 4U);
  EXPECT_EQ(comments, (std::vector<std::string>{"frame: arm", "end"}));
  EXPECT_FALSE(reader.next());
}

// Fault 54: a table garbage, cut or of another encoding -> refused with file, line, column and text
TEST(Table, RefusesWithFileLineAndColumn) {
  const auto said = [](const std::string& text) { return refusal([&] { (void)read(text); }); };
  EXPECT_EQ(said(""), "table: is empty, must have the header t,x");
  EXPECT_EQ(said("time;x\n"), "table: no column t, there are \"time, x\"");
  EXPECT_EQ(said("t,x\n1,2\n\n1,two\n"), "table, line 4: x = \"two\", must be a finite number");
  EXPECT_EQ(said("t,x\n1\n"), "table, line 2: 1 values, must be 2");
  EXPECT_EQ(said("t;x\n1;2,3,4\n"), "table, line 2: x = \"2,3,4\", must be a finite number");
  for (const char* word : {"nan", "inf", "1e999", "", "0x1p3", "1 2", "++1"}) {
    EXPECT_NE(said("t,x\n1," + std::string(word) + "\n"), "") << word;
  }
  EXPECT_EQ(said(std::string("\xff\xfet\0,\0", 6)),
            "table: is UTF-16, must be UTF-8 or plain ASCII");
  EXPECT_EQ(refusal([] { (void)open_table("absent.csv"); }), "absent.csv: there is no such file");
  EXPECT_EQ(refusal([] { (void)open_table("/dev/zero"); }),
            "/dev/zero: cannot be read, must be a file");
  EXPECT_EQ(refusal([] { (void)open_table("."); }), ".: cannot be read, must be a file");
}

}  // namespace
}  // namespace prf_core
