// SPDX-License-Identifier: BSD-3-Clause
//
// Counts the program's allocations (not under AddressSanitizer, which has its own malloc). To be
// included by one source file of a program.
#pragma once

#include <cstdlib>

#ifndef __SANITIZE_ADDRESS__
#define ELTE_PLANNER_COUNTS_ALLOCATIONS
extern "C" void* __libc_malloc(std::size_t size);

namespace {
long g_allocations = 0;
}

extern "C" void* malloc(std::size_t size) {
  ++g_allocations;
  return __libc_malloc(size);
}
#endif
