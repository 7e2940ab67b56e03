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

/// A file that is read, or standard input for "-". What is in memory is a block that grows in place and is
/// not filled with zeros first.
class InputFile : public Source {
 public:
  /// Throws: BadInput if the file cannot be opened. Of the others, `next` does if it is empty or unreadable.
  explicit InputFile(const std::string& path);
  ~InputFile() override;
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  std::string_view next(std::size_t n) override;
  void drop(std::size_t n) override { begin_ += n; }
  void skip(std::size_t n) override;
  std::size_t most_left() const override { return end_ - begin_ + unread_; }
  std::string_view rest() { return next(std::string_view::npos); }

 private:
  void reserve(std::size_t more);
  /// Reads some bytes; at the end of the file, none.
  void read_some();

  std::string where_;
  int fd_;
  std::unique_ptr<char, decltype(&std::free)> data_{nullptr, std::free};
  std::size_t begin_ = 0, end_ = 0, capacity_ = 0;
  std::size_t unread_ = std::size_t(-1) / 2;  ///< bytes, at most
  bool known_ = false;                        ///< is `unread_` what a file has?
  bool any_ = false, ended_ = false;
};

/// Returns the bytes of a file of the user's, or of standard input for "-". Throws: as InputFile.
std::string read_bytes(const std::string& path);

/// Reads all of a file in any format, or one of the `several` streams of a shard; see read_stream. Throws: as
/// read_any.
Stream read_next(InputFile& file, const std::string& where, bool several = false, const Wanted& wanted = {});

/// Writes all bytes to an open file; `where` names it in messages. Throws CannotWrite.
void write_all(int fd, std::string_view bytes, const std::string& where);

/// A file that gets its name only when it is complete, and is gone if finish was not called; "-", devices and
/// pipes are written to directly. One at a time. All throw CannotWrite.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();
  void write(std::string_view bytes);
  void finish();

 private:
  std::string path_, partial_;  // partial_: its name so far; empty if it is written to directly
  int fd_ = -1;
  int mode_ = -1;  // of the file that it replaces
  bool is_stdout_ = false;
};

/// Writes a file piece by piece: `produce` hands the pieces to its sink.
void write_atomically(const std::string& path, const std::function<void(const Sink&)>& produce);

/// Adds a line to a file at once, after the heading if the file is new or empty. Throws CannotWrite.
void append_line(const std::string& path, std::string_view heading, std::string_view line);
/// Throws: CannotWrite if a file has another first line than this heading, and is not empty.
void expect_heading(const std::string& path, std::string_view heading);

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
