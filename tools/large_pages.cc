// SPDX-License-Identifier: BSD-3-Clause
// Large arrays on large pages, used again when they are freed: a surface of millions of triangles is a few
// arrays of hundreds of megabytes, and more than half of the time to read and weld it would go into fresh
// pages of 4 KB.
#include <malloc.h>
#include <sys/mman.h>

#include <cstdlib>
#include <new>

namespace {
constexpr std::size_t page = std::size_t{1} << 21;
}  // namespace

void* operator new(std::size_t bytes) {
  void* memory;
  if (bytes < 2 * page) {
    memory = std::malloc(bytes ? bytes : 1);
  } else {
    memory =
        bytes > std::size_t(-1) - page ? nullptr : std::aligned_alloc(page, (bytes + page - 1) / page * page);
    if (memory) ::madvise(memory, bytes, MADV_HUGEPAGE);
  }
  if (!memory) throw std::bad_alloc();
  return memory;
}

void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
