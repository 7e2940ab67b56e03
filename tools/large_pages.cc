// SPDX-License-Identifier: BSD-3-Clause
// Memory on large pages. Arrays of megabytes: a surface of millions of triangles is a few arrays of hundreds
// of megabytes, and more than half of the time to read and weld it would go into fresh pages of 4 KB. And the
// heap: at 70,000 triangles a stage takes thousands of fresh pages, which is a tenth of the time of the
// chain.
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <new>

namespace {
constexpr std::size_t page = std::size_t{1} << 21;  // bytes, as all here

/// Lets the heap grow by a piece at a time, which takes no memory before it is used, and puts the first on
/// large pages.
[[gnu::constructor(102)]] void enlarge_heap() {
  constexpr int piece = 32 << 20, reserved = 8 << 20;
  ::mallopt(M_TOP_PAD, piece);
  ::mallopt(M_MMAP_THRESHOLD, reserved);
  void* memory = std::malloc(reserved / 2);
  const auto end = reinterpret_cast<std::uintptr_t>(::sbrk(0));
  const auto start = reinterpret_cast<std::uintptr_t>(memory) / page * page + page;
  if (memory && start < end && end - start < 2 * std::size_t{piece})
    ::madvise(reinterpret_cast<void*>(start), end - start, MADV_HUGEPAGE);
  std::free(memory);
}
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
