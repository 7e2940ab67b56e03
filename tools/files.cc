// SPDX-License-Identifier: BSD-3-Clause
#include "tools/files.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <new>
#include <utility>

#include "formats/formats.h"
#include "lib/core/error.h"
#include "tools/progress_line.h"

namespace meshpipe {
namespace {

/// The file that is being written and does not have its final name yet. While it is created its name is not
/// known: a signal then waits in `creating`, whichever thread received it.
char partial_file[4096];
std::atomic<bool> partial_file_exists = false;
constexpr int not_creating = -1, no_signal = 0;
std::atomic<int> creating = not_creating;

extern "C" void end_on_signal(int signal) {
  int none = no_signal;
  if (creating.compare_exchange_strong(none, signal)) return;
  if (partial_file_exists) ::unlink(partial_file);
  std::signal(signal, SIG_DFL);
  ::raise(signal);  // ends the program when this handler has returned
}

/// Creates a file whose name ends in XXXXXX; the signal handler knows it from the moment it exists.
int create_partial_file(std::string& name) {
  if (name.size() >= sizeof partial_file) {
    errno = ENAMETOOLONG;
    return -1;
  }
  creating = no_signal;
  const int fd = ::mkstemp(name.data());
  if (fd >= 0) {
    std::strcpy(partial_file, name.c_str());
    partial_file_exists = true;
  }
  if (const int signal = creating.exchange(not_creating); signal != no_signal) end_on_signal(signal);
  return fd;
}

constexpr std::size_t block = 1 << 20;  // bytes, of a pipe and of what is read at a time

std::string last_error() { return std::strerror(errno); }

/// Returns whether a path is written to directly: devices, pipes, and the names of open descriptors
/// (/dev/stderr is a link, possibly to a regular file).
bool is_written_in_place(const std::string& path, const struct stat& info) {
  return !S_ISREG(info.st_mode) || path.starts_with("/dev/std") || path.starts_with("/dev/fd/") ||
         path.starts_with("/proc/");
}

/// Returns where a path leads: links are followed, also to a file that is not there yet, so that writing
/// keeps them. Paths that are written in place stay.
std::string end_of_links(const std::string& path) {
  constexpr int most_links = 40;  // as Linux follows
  struct stat info {};
  std::filesystem::path end = path;
  std::error_code none;
  for (int i = 0; i < most_links; ++i) {
    if (::stat(end.c_str(), &info) == 0 && is_written_in_place(end, info)) return path;
    if (!std::filesystem::is_symlink(end, none)) break;
    end = end.parent_path() / std::filesystem::read_symlink(end, none);
  }
  return end.string();
}

}  // namespace

void InputFile::reserve(std::size_t more) {
  if (end_ + more <= capacity_) return;
  capacity_ = std::max(end_ + more, 2 * capacity_);
  char* larger = static_cast<char*>(std::realloc(data_.get(), capacity_));
  if (!larger) throw std::bad_alloc();
  (void)data_.release();
  data_.reset(larger);
  // large pages are filled much faster by a file of hundreds of megabytes
  constexpr std::size_t page = 4096, large = std::size_t{1} << 22;
  if (capacity_ > large)
    ::madvise(larger + (page - reinterpret_cast<std::uintptr_t>(larger) % page), capacity_ - page,
              MADV_HUGEPAGE);
}

InputFile::InputFile(const std::string& path)
    : where_(path == "-" ? "stdin" : path), fd_(path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY)) {
  if (fd_ < 0) throw BadInput(where_ + ": " + last_error());
  struct stat info {};
  if (::fstat(fd_, &info) == 0 && S_ISREG(info.st_mode) && info.st_size > 0)
    known_ = true, unread_ = info.st_size;
#ifdef F_SETPIPE_SZ
  // a pipe that holds more: its two programs wake each other sixteen times less often
  ::fcntl(fd_, F_SETPIPE_SZ, static_cast<int>(block));
#endif
}

InputFile::~InputFile() {
  if (fd_ > STDIN_FILENO) ::close(fd_);
}

void InputFile::read_some() {
  ssize_t n;
  do n = ::read(fd_, data_.get() + end_, capacity_ - end_);
  while (n < 0 && errno == EINTR);
  if (n < 0) throw BadInput(where_ + ": " + last_error());
  if (n == 0 && !any_) throw BadInput(where_ + ": the input is empty");
  if (!any_) note_input_begins();
  any_ = true;
  ended_ = n == 0;
  end_ += n;
  unread_ = ended_ ? 0 : unread_ - std::min<std::size_t>(unread_, n);
}

std::string_view InputFile::next(std::size_t n) {
  while (end_ - begin_ < n && !ended_) {
    if (end_ == capacity_ && begin_ > 0) {
      std::memmove(data_.get(), data_.get() + begin_, end_ - begin_);
      end_ -= std::exchange(begin_, 0);
    }
    // one byte more than the file has, so that its end is seen without growing
    if (end_ == capacity_) reserve(known_ && n > unread_ ? unread_ + 1 : block);
    read_some();
  }
  return {data_.get() + begin_, end_ - begin_};
}

void InputFile::skip(std::size_t n) {
  const std::size_t held = std::min(n, end_ - begin_), far = n - held;
  begin_ += held;
  if (known_ && far <= unread_ && ::lseek(fd_, static_cast<off_t>(far), SEEK_CUR) >= 0)
    unread_ -= far;
  else
    Source::skip(far);
}

Stream read_next(InputFile& file, const std::string& where, bool several, const Wanted& wanted) {
  constexpr std::size_t start = 200;  // bytes that show a stream
  if (is_stream(file.next(start))) return read_stream(file, where, several, wanted);
  const std::string_view bytes = file.rest();
  Stream stream = read_any(bytes, where);
  file.drop(bytes.size());
  return stream;
}

void write_all(int fd, std::string_view bytes, const std::string& where) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0)
      throw CannotWrite(where + ": " + last_error() + " with " + std::to_string(bytes.size()) +
                        " bytes left to write");
    bytes.remove_prefix(n);
  }
}

AtomicFile::AtomicFile(const std::string& name) {
  if (name == "-" || name == "/dev/stdout") {
    path_ = "stdout", fd_ = STDOUT_FILENO, is_stdout_ = true;
    return;
  }
  path_ = end_of_links(name);
  struct stat info {};
  const bool exists = ::stat(path_.c_str(), &info) == 0;
  if (exists) mode_ = static_cast<int>(info.st_mode & 0777);
  if (!exists || !is_written_in_place(path_, info)) partial_ = path_ + ".XXXXXX";
  fd_ = partial_.empty() ? ::open(path_.c_str(), O_WRONLY) : create_partial_file(partial_);
  if (fd_ < 0) throw CannotWrite(path_ + ": " + last_error());
}

AtomicFile::~AtomicFile() {
  if (fd_ >= 0 && !is_stdout_) ::close(fd_);
  if (partial_.empty()) return;
  ::unlink(partial_.c_str());
  partial_file_exists = false;
}

void AtomicFile::write(std::string_view bytes) { write_all(fd_, bytes, path_); }

void AtomicFile::finish() {
  if (is_stdout_) return;
  if (!partial_.empty()) {
    const mode_t mask = ::umask(0);
    ::umask(mask);
    ::fchmod(fd_, mode_ >= 0 ? static_cast<mode_t>(mode_) : 0666 & ~mask);
  }
  if (::close(std::exchange(fd_, -1)) != 0) throw CannotWrite(path_ + ": " + last_error());
  if (partial_.empty()) return;
  if (::rename(partial_.c_str(), path_.c_str()) != 0) throw CannotWrite(path_ + ": " + last_error());
  partial_.clear();
  partial_file_exists = false;
}

void write_atomically(const std::string& path, const std::function<void(const Sink&)>& produce) {
  AtomicFile file(path);
  produce([&](std::string_view bytes) { file.write(bytes); });
  file.finish();
}

void append_line(const std::string& path, std::string_view heading, std::string_view line) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT, 0666);
  if (fd < 0) throw CannotWrite(path + ": " + last_error());
  std::string text(line);
  struct stat info {};
  ::flock(fd, LOCK_EX);  // of two that find it empty, one writes the heading
  if (::fstat(fd, &info) == 0 && info.st_size == 0) text.insert(0, heading);
  try {
    write_all(fd, text, path);
  } catch (...) {
    ::close(fd);
    throw;
  }
  if (::close(fd) != 0) throw CannotWrite(path + ": " + last_error());
}

void expect_heading(const std::string& path, std::string_view heading) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error) || std::filesystem::file_size(path, error) == 0) return;
  if (!read_bytes(path).starts_with(heading))
    throw CannotWrite(path + ":1: the table has other columns; give a new file");
}

void expect_writable(const std::string& name) {
  if (name == "-") return;
  const std::string path = end_of_links(name);
  struct stat info {};
  const bool exists = ::stat(path.c_str(), &info) == 0;
  if (!exists && errno == ELOOP) throw CannotWrite(path + ": " + last_error());
  if (exists && S_ISDIR(info.st_mode)) throw CannotWrite(path + ": " + std::strerror(EISDIR));
  const std::size_t slash = path.rfind('/');
  const std::string directory = slash == path.npos ? "." : path.substr(0, slash + 1);
  const std::string& target = exists && is_written_in_place(path, info) ? path : directory;
  if (::access(target.c_str(), W_OK) != 0) throw CannotWrite(path + ": " + last_error());
}

void expect_readable(const std::string& path) {
  if (path != "-" && ::access(path.c_str(), R_OK) != 0) throw BadInput(path + ": " + last_error());
}

bool can_be_read_again(const std::string& path) {
  struct stat info {};
  return path != "-" && (::stat(path.c_str(), &info) != 0 || S_ISREG(info.st_mode));
}

bool is_same_file(const std::string& a, const std::string& b) {
  if (a == "-" || b == "-") return a == b;
  std::error_code error;
  const auto place = [&](const std::string& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path, error), error);
  };
  return place(a) == place(b) &&
         (!std::filesystem::exists(a, error) || std::filesystem::is_regular_file(a, error));
}

void remove_file(const std::string& name) {
  const std::string path = end_of_links(name);
  struct stat info {};
  if (::stat(path.c_str(), &info) == 0 && !is_written_in_place(path, info)) ::unlink(path.c_str());
}

void remove_partial_file_on_signals() {
  struct sigaction action {};
  action.sa_handler = end_on_signal;
  action.sa_flags = SA_RESTART;
  ::sigfillset(&action.sa_mask);  // a second signal must not end the program before the file is gone
  for (int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction now {};
    if (::sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_DFL)
      ::sigaction(signal, &action, nullptr);
  }
  std::signal(SIGXFSZ, SIG_IGN);
}

std::string read_bytes(const std::string& path) { return std::string(InputFile(path).rest()); }

}  // namespace meshpipe
