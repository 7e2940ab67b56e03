// SPDX-License-Identifier: BSD-3-Clause
// Memory on large pages. Arrays of megabytes: a surface of millions of triangles is a few arrays of hundreds
// of megabytes, and more than half of the time to read and weld it would go into fresh pages of 4 KB. What is
// freed of it is used again: a stage allocates up to seven times what it needs at a time, and the system
// clears fresh pages at a tenth of the cost of the chain. And the heap: at 70,000 triangles a stage takes
// thousands of fresh pages, which is a tenth of the time of the chain.
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <mutex>
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

/// Ranges of large pages, in use and free. Never holds more than was in use at some time, and of free ones an
/// eighth of that, or 128 MB: with twice the share the programs need a tenth more memory, as not all arrays
/// are filled; with the 128 MB mpartition takes a third fewer fresh pages for a million triangles.
class Ranges {
 public:
  /// Returns null where there is no memory.
  void* take(std::size_t wanted) {
    const std::lock_guard lock(mutex_);
    const std::size_t bytes = (wanted + page - 1) / page * page;
    // the tightest of those that are free
    auto best = free_.end();
    for (auto i = free_.begin(); i != free_.end(); ++i)
      if (i->second >= bytes && (best == free_.end() || i->second < best->second)) best = i;
    char* start;
    if (best != free_.end()) {
      start = best->first;
      if (best->second > bytes) free_[start + bytes] = best->second - bytes;
      held_ -= bytes;
      free_.erase(start);
    } else {
      while (held_ > 0 && in_use_ + held_ + bytes > most_) release(in_use_ + held_ + bytes - most_);
      start = fresh(bytes);
      while (!start && held_ > 0) release(held_), start = fresh(bytes);
      if (!start) return nullptr;
      ::madvise(start, wanted, MADV_HUGEPAGE);  // the rest of the last page may be much, and is not needed
    }
    used_[start] = bytes;
    in_use_ += bytes;
    most_ = std::max(most_, in_use_);
    return start;
  }

  /// Returns whether the memory was one of the ranges.
  bool give_back(void* memory) {
    const std::lock_guard lock(mutex_);
    const auto range = used_.find(static_cast<char*>(memory));
    if (range == used_.end()) return false;
    const std::size_t bytes = range->second;
    used_.erase(range);
    in_use_ -= bytes;
    held_ += bytes;
    auto at = free_.emplace(static_cast<char*>(memory), bytes).first;
    const auto join = [&](auto low, auto high) {
      if (low->first + low->second != high->first) return false;
      low->second += high->second;
      free_.erase(high);
      return true;
    };
    if (const auto after = std::next(at); after != free_.end()) join(at, after);
    if (at != free_.begin()) join(std::prev(at), at);
    const std::size_t may_hold = std::max(most_ / share_held, least_held);
    while (held_ > may_hold) release(held_ - may_hold);
    return true;
  }

 private:
  static constexpr std::size_t share_held = 8, least_held = std::size_t{128} << 20;

  static char* fresh(std::size_t bytes) {
    void* memory = ::mmap(nullptr, bytes + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) return nullptr;
    char* const first = static_cast<char*>(memory);
    const std::size_t before = (page - reinterpret_cast<std::uintptr_t>(first) % page) % page;
    if (before > 0) ::munmap(first, before);
    if (before < page) ::munmap(first + before + bytes, page - before);
    return first + before;
  }
  /// Gives free ranges, the last first, back to the system, until they are as many bytes.
  void release(std::size_t bytes) {
    const auto last = std::prev(free_.end());
    const std::size_t part = std::min(last->second, (bytes + page - 1) / page * page);
    last->second -= part;
    held_ -= part;
    ::munmap(last->first + last->second, part);
    if (last->second == 0) free_.erase(last);
  }

  std::mutex mutex_;
  std::map<char*, std::size_t> used_, free_;
  std::size_t in_use_ = 0, held_ = 0, most_ = 0;
};

Ranges& ranges() {
  static Ranges* const all = new Ranges;  // outlives all that is freed at the end
  return *all;
}
}  // namespace

void* operator new(std::size_t bytes) {
  void* memory;
  if (bytes < 2 * page) {
    memory = std::malloc(bytes ? bytes : 1);
  } else {
    memory = bytes > std::size_t(-1) / 2 ? nullptr : ranges().take(bytes);
  }
  if (!memory) throw std::bad_alloc();
  return memory;
}

void operator delete(void* memory) noexcept {
  if (reinterpret_cast<std::uintptr_t>(memory) % page != 0 || !memory || !ranges().give_back(memory))
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }
