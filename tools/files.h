// SPDX-License-Identifier: BSD-3-Clause
// Whole files read at once, and files that appear complete or not at all.
#pragma once
#include <sys/stat.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>

#include "formats/stream.h"

namespace meshpipe {

/// The bytes of a file, in a block that grows in place and is not filled with zeros first.
class FileBytes {
 public:
  /// Makes space for `more` bytes after those read. Throws std::bad_alloc.
  void reserve(std::size_t more);
  char* end() const { return data_.get() + size_; }
  std::size_t space() const { return capacity_ - size_; }
  void add(std::size_t n) { size_ += n; }
  operator std::string_view() const { return {data_.get(), size_}; }

 private:
  std::unique_ptr<char, decltype(&std::free)> data_{nullptr, std::free};
  std::size_t size_ = 0, capacity_ = 0;
};

/// Reads a file, or standard input for "-".
/// Throws: BadInput if the file cannot be read or is empty.
FileBytes read_file(const std::string& path);

/// Writes all bytes to an open file; `where` names it in messages. Throws CannotWrite.
void write_all(int fd, std::string_view bytes, const std::string& where);

/// Writes a file piece by piece: `produce` hands the pieces to its sink. The file gets its name only when it
/// is complete; "-", devices and pipes are written to directly. Throws CannotWrite.
void write_atomically(const std::string& path, const std::function<void(const Sink&)>& produce);

/// Adds a line to a file at once, after the heading if the file is new or empty. Throws CannotWrite.
void append_line(const std::string& path, std::string_view heading, std::string_view line);

/// Checks before the work that write_atomically can write the file. Throws CannotWrite.
void expect_writable(const std::string& path);

/// Checks before the work that a file can be opened, without opening it: a pipe can be read only once.
/// Throws: BadInput.
void expect_readable(const std::string& path);
/// Returns whether a path is no pipe or device, from which the same bytes cannot be read twice.
bool can_be_read_again(const std::string& path);

/// Returns whether writing to one path overwrites what was written to the other; devices may be named twice.
bool is_same_file(const std::string& a, const std::string& b);

/// Removes a finished file after a later failure; devices and pipes stay.
void remove_file(const std::string& path);

/// Makes SIGINT, SIGTERM and SIGHUP remove the file that is being written before they end the program, and a
/// file beyond the size limit (SIGXFSZ) a write that fails.
void remove_partial_file_on_signals();

}  // namespace meshpipe
