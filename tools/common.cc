// SPDX-License-Identifier: BSD-3-Clause
#include "tools/common.h"

#include <fcntl.h>
#include <malloc.h>
#include <omp.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <condition_variable>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <memory>
#include <mutex>
#include <new>
#include <thread>

#include "formats/losses.h"
#include "formats/stl.h"
#include "lib/progress.h"

namespace meshpipe {
namespace {

constexpr const char* common_group = "Common options";

/// Threads that wait must not keep the other programs of a pipe from working. OpenMP reads this before main,
/// and after this if it is linked as an archive; mremesh sets it for where it is not.
[[gnu::constructor(101)]] void wait_passively() { ::setenv("OMP_WAIT_POLICY", "passive", 0); }

/// The file that is being written and has its name not yet: a program that is stopped removes it. While it
/// is being made its name is not known: a signal then waits in `making`, whichever thread it came to.
char temporary_file[4096];
std::atomic<bool> temporary_exists = false;
constexpr int not_making = -1, nothing_waits = 0;
std::atomic<int> making = not_making;

extern "C" void remove_temporary(int signal) {
  int none = nothing_waits;
  if (making.compare_exchange_strong(none, signal)) return;
  if (temporary_exists) ::unlink(temporary_file);
  std::signal(signal, SIG_DFL);
  ::raise(signal);  // ends the program when this handler has returned
}

void handle_signals() {
  struct sigaction action {};
  action.sa_handler = remove_temporary;
  action.sa_flags = SA_RESTART;
  ::sigfillset(&action.sa_mask);  // a second signal must not end the program before the file is gone
  for (int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction now {};
    if (::sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_DFL)
      ::sigaction(signal, &action, nullptr);
  }
  std::signal(SIGXFSZ, SIG_IGN);  // a file too large is a write that fails
}

/// A file beside `path`, known to the handler from the moment it exists.
int make_temporary(std::string& name) {
  if (name.size() >= sizeof temporary_file) {
    errno = ENAMETOOLONG;
    return -1;
  }
  making = nothing_waits;
  const int fd = ::mkstemp(name.data());
  if (fd >= 0) {
    std::strcpy(temporary_file, name.c_str());
    temporary_exists = true;
  }
  if (const int signal = making.exchange(not_making); signal != nothing_waits) remove_temporary(signal);
  return fd;
}

/// What the program is at, for the line of progress; in a pipe it first waits for its input.
enum class Phase { waiting, reading, working, writing };
std::atomic<Phase> phase = Phase::waiting;

/// Share of all that has to be done. Reading and writing a stream take about as long as each other.
double share_done() {
  constexpr double to_read = 0.2, to_write = 0.2;
  switch (phase.load()) {
    case Phase::working:
      return to_read + (1 - to_read - to_write) * std::min(1.0, work_done.load());
    case Phase::writing:
      return 1 - to_write;
    default:
      return 0;
  }
}

std::string reason() { return std::strerror(errno); }

void write_all(int fd, std::string_view bytes, const std::string& where) {
  while (!bytes.empty()) {
    ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0)
      throw CannotWrite(where + ": " + reason() + " with " + std::to_string(bytes.size()) +
                        " bytes left to write");
    bytes.remove_prefix(n);
  }
}

/// The bytes of a file, which may be large: not filled with zeros first, and large blocks grow in their
/// place.
struct Bytes {
  std::unique_ptr<char, decltype(&std::free)> data{nullptr, std::free};
  std::size_t size = 0, capacity = 0;

  void grow(std::size_t more) {
    if (size + more <= capacity) return;
    capacity = std::max(size + more, 2 * capacity);
    char* larger = static_cast<char*>(std::realloc(data.get(), capacity));
    if (!larger) throw std::bad_alloc();
    (void)data.release();
    data.reset(larger);
    // whole pages of it may be large ones, which a file of hundreds of megabytes is filled into much faster
    constexpr std::size_t page = 4096;
    if (capacity > (std::size_t{1} << 22))
      ::madvise(larger + (page - reinterpret_cast<std::uintptr_t>(larger) % page), capacity - page,
                MADV_HUGEPAGE);
  }
  operator std::string_view() const { return {data.get(), size}; }
};

Bytes read_all(const std::string& path) {
  const bool standard = path == "-";
  const std::string where = standard ? "stdin" : path;
  int fd = standard ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY);
  if (fd < 0) throw BadInput(where + ": " + reason());
  Bytes bytes;
  struct stat info {};
  // a byte more, so that the end is seen without growing
  if (::fstat(fd, &info) == 0 && S_ISREG(info.st_mode)) bytes.grow(info.st_size + 1);
  for (;;) {
    if (bytes.size == bytes.capacity) bytes.grow(1 << 18);
    ssize_t n = ::read(fd, bytes.data.get() + bytes.size, bytes.capacity - bytes.size);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      std::string why = reason();
      if (!standard) ::close(fd);
      throw BadInput(where + ": " + why);
    }
    if (n == 0) break;
    if (phase == Phase::waiting) phase = Phase::reading;
    bytes.size += n;
  }
  if (!standard) ::close(fd);
  if (bytes.size == 0) throw BadInput(where + ": the input is empty");
  return bytes;
}

/// The stream is written for .ply, for no extension and on standard output, else the format of the extension.
bool is_stream_name(const std::string& path) {
  const std::string extension = extension_of(path);
  return path == "-" || extension.empty() || extension == ".ply";
}

/// The bytes of a file, in pieces.
void encode(const std::string& path, const Stream& stream, bool text, const Sink& sink) {
  if (is_stream_name(path))
    write_stream(stream, text, sink);
  else
    sink(write_as(stream, path, text));
}

/// A device or a pipe is written to, not replaced; so is what the names of open descriptors lead to
/// (/dev/stderr is a link, to a regular file if that is where standard error goes).
bool in_place(const std::string& path, const struct stat& info) {
  return !S_ISREG(info.st_mode) || path.starts_with("/dev/std") || path.starts_with("/dev/fd/") ||
         path.starts_with("/proc/");
}

/// Writes what `produce` hands to its sink to a file, beside it and renamed; "-" is standard output.
void write_beside(const std::string& path, const std::function<void(const Sink&)>& produce) {
  if (path == "-" || path == "/dev/stdout") {
    produce([](std::string_view bytes) { write_all(STDOUT_FILENO, bytes, "stdout"); });
    return;
  }
  struct stat info {};
  const bool exists = ::stat(path.c_str(), &info) == 0;
  std::string temporary = exists && in_place(path, info) ? "" : path + ".XXXXXX";
  int fd = temporary.empty() ? ::open(path.c_str(), O_WRONLY) : make_temporary(temporary);
  if (fd < 0) throw CannotWrite(path + ": " + reason());
  try {
    produce([&](std::string_view bytes) { write_all(fd, bytes, path); });
    if (!temporary.empty()) {
      mode_t mask = ::umask(0);
      ::umask(mask);
      ::fchmod(fd, exists ? info.st_mode & 0777 : 0666 & ~mask);
    }
    int closed = ::close(fd);
    fd = -1;
    if (closed != 0) throw CannotWrite(path + ": " + reason());
    if (!temporary.empty() && ::rename(temporary.c_str(), path.c_str()) != 0)
      throw CannotWrite(path + ": " + reason());
    temporary_exists = false;
  } catch (...) {
    if (fd >= 0) ::close(fd);
    if (!temporary.empty()) ::unlink(temporary.c_str());
    temporary_exists = false;
    throw;
  }
}

/// Throws CannotWrite if the file cannot be written now, and BadUsage if a `mesh` has no format by its name.
void expect_writable(const std::string& path, bool mesh) {
  if (mesh && !is_stream_name(path)) writer_of(path);
  if (path == "-") return;
  struct stat info {};
  const bool exists = ::stat(path.c_str(), &info) == 0;
  if (exists && S_ISDIR(info.st_mode)) throw CannotWrite(path + ": " + std::strerror(EISDIR));
  const std::size_t slash = path.rfind('/');
  const std::string directory = slash == path.npos ? "." : path.substr(0, slash + 1);
  const std::string& target = exists && in_place(path, info) ? path : directory;
  if (::access(target.c_str(), W_OK) != 0) throw CannotWrite(path + ": " + reason());
}

/// Whether what is written to one of them is lost when the other is written; devices take both.
bool same_file(const std::string& a, const std::string& b) {
  if (a == "-" || b == "-") return a == b;
  std::error_code error;
  const auto place = [&](const std::string& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path, error), error);
  };
  return place(a) == place(b) &&
         (!std::filesystem::exists(a, error) || std::filesystem::is_regular_file(a, error));
}

/// The options given on the command line that change the result, as they are recorded in the stream.
std::string recorded(const CLI::App& app) {
  std::string out;
  for (const CLI::Option* o : app.get_options()) {
    if (o->count() == 0 || o->get_group() == common_group || o->get_group() == "Reports") continue;
    if (!out.empty()) out += ' ';
    out += o->get_name(!o->nonpositional());
    if (o->get_expected_min() == 0) continue;
    const bool file = o->get_type_name().starts_with("FILE");  // its name depends on where the program ran
    char between = '=';
    for (std::string r : o->results()) {
      if (file && r != "none") {  // but not the name of what is in it
        const std::size_t colon = o->get_type_name() == "FILE[:NAME]" ? r.rfind(':') : r.npos;
        if (colon == r.npos) continue;
        r.erase(0, colon);
      }
      out += between + r;
      between = ',';
    }
  }
  return out;
}

/// --help without what is only of interest to a programmer: names of types, checks and exclusions.
struct Help : CLI::Formatter {
  std::string make_option_opts(const CLI::Option* o) const override {
    if (o->get_type_size() == 0) return "";
    const std::string text = o->get_type_name();  // of the type, and of the checks after a colon
    const std::size_t colon = text.ends_with("[:NAME]") ? text.npos : text.find(':');
    const std::string type = text.substr(0, colon), check = colon == text.npos ? "" : text.substr(colon + 1);
    if (type.empty()) return "";
    if (type == "TEXT" && check.starts_with('{') && check.ends_with('}')) {
      std::string words = check.substr(1, check.size() - 2);
      std::replace(words.begin(), words.end(), ',', '|');
      return words.insert(0, " ");
    }
    std::string shown = " ";
    return shown += type == "INT" || type == "UINT" ? "N" : type == "FLOAT" ? "X" : type;
  }
};

/// On a terminal, a line that tells how far the work is and how long it will take, from the moment that it
/// has taken a second. Cleared at the end.
class Progress {
 public:
  explicit Progress(const Io& io) {
    if (!io.quiet && ::isatty(STDERR_FILENO))
      thread_ = std::thread([this, name = io.program] { watch(name); });
  }
  ~Progress() {
    if (!thread_.joinable()) return;
    {
      const std::lock_guard lock(mutex_);
      over_ = true;
    }
    wake_.notify_one();
    thread_.join();
  }

 private:
  void watch(const std::string& name) {
    using Clock = std::chrono::steady_clock;
    Clock::time_point begun{};
    bool shown = false;
    std::unique_lock lock(mutex_);
    while (!wake_.wait_for(lock, std::chrono::milliseconds(200), [this] { return over_; })) {
      if (phase == Phase::waiting) continue;
      if (begun == Clock::time_point{}) begun = Clock::now();
      const double seconds = std::chrono::duration<double>(Clock::now() - begun).count(),
                   share = share_done();
      if (seconds < 1 || share <= 0) continue;
      std::fprintf(stderr, "\r%s: %.0f %%, %.0f s left\033[K\r", name.c_str(), 100 * share,
                   seconds * (1 - share) / share);
      shown = true;
    }
    if (shown) std::fputs("\r\033[K", stderr);
  }

  std::thread thread_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool over_ = false;
};

}  // namespace

Stream Io::read() {
  if (input == "-" && ::isatty(STDIN_FILENO))
    throw BadUsage("no FILE, and standard input is a terminal; see " + program + " --help");
  Stream stream = read(input);
  phase = Phase::working;
  return stream;
}

std::string Io::read_bytes(const std::string& path) { return std::string(std::string_view(read_all(path))); }

Stream Io::read(const std::string& path) const {
  Stream stream = read_any(read_all(path), path == "-" ? "stdin" : path);
  // what the reader of a foreign file had to leave out; a stream brings the remarks of programs that have
  // told
  if (stream.history.empty())
    for (const std::string& remark : stream.remarks) say(remark);
  if (!any_size_) expect_measurable(stream.surface);
  return stream;
}

bool Io::needs_text(const std::string& path, const Stream& stream) const {
  if (extension_of(path) != ".stl") return false;
  const std::string why = beyond_single_precision(stream.surface);
  if (why.empty()) return false;
  if (binary) throw CannotWrite(path + ": single precision of binary .stl does not hold the surface: " + why);
  say(path + " is written as text, single precision of binary .stl does not hold the surface: " + why);
  return true;
}

bool Io::text_for(const Stream& stream) const {
  const std::string extension = extension_of(output);
  // only the text of STL has room for patches and their names
  const bool named = extension == ".stl" && !binary && !stream.names.empty();
  const bool text = ascii || named || (stream.ascii && !binary) || needs_text(output, stream);
  if (is_stream_name(output) && program != "mconvert") return text;
  if (const std::string lost = lost_in(stream, output, text); !lost.empty())
    say("left out, " + std::string(extension == ".stl" && !text ? "binary " : "") + extension +
        " has no room for it: " + lost);
  return text;
}

void Io::write(Stream& stream) {
  stream.history.push_back({program, MESHPIPE_VERSION, arguments_});
  const bool text = text_for(stream);
  if (output == "-" && !text && ::isatty(STDOUT_FILENO))
    throw BadUsage("the stream is binary and standard output is a terminal; use -o FILE, a pipe or --ascii");
  auto produce = [&](const Sink& sink) { encode(output, stream, text, sink); };
  phase = Phase::writing;
  if (output != "-") {
    write_beside(output, produce);
    finished_ = output;
    return;
  }
  written_ = true;
  produce([](std::string_view bytes) { write_all(STDOUT_FILENO, bytes, "stdout"); });
}

void Io::write_to(const std::string& path, const Stream& stream) const {
  const bool text = ascii || needs_text(path, stream);
  write_beside(path, [&](const Sink& sink) { encode(path, stream, text, sink); });
}

void Io::write_bytes(std::string_view bytes) const {
  if (output != "-") {
    write_file(output, bytes);
    finished_ = output;
    return;
  }
  written_ = true;
  write_all(STDOUT_FILENO, bytes, "stdout");
}

void Io::write_file(const std::string& path, std::string_view bytes) {
  write_beside(path, [&](const Sink& sink) { sink(bytes); });
}

void Io::expect_report(const std::string& option, const std::string& path, bool mesh) {
  for (const auto& [other, file] : files_)
    if (same_file(path, file)) {
      throw BadUsage(option + ' ' + path + ": " +
                     (path != "-"     ? "that is the file of " + other
                      : other == "-o" ? "standard output is for the result; give -o FILE"
                                      : "standard output is for " + other));
    }
  files_.push_back({option, path});
  expect_writable(path, mesh);
}

void Io::say(const std::string& line) const {
  // on a terminal over the line of progress
  const char* clear = ::isatty(STDERR_FILENO) ? "\r\033[K" : "";
  if (!quiet) std::fprintf(stderr, "%s%s: %s\n", clear, program.c_str(), line.c_str());
}

void Io::detail(const std::string& line) const {
  if (verbose) say(line);
}

CLI::Validator positive_number() {
  return {[](std::string& text) {
            double x = 0;
            const bool good = CLI::detail::lexical_cast(text, x) && std::isfinite(x) && x > 0;
            return good ? std::string() : "'" + text + "' is not a positive number";
          },
          ""};
}

double most_triangles() {
  // the largest programs of the chain take 300 bytes a triangle, and two of them hold theirs at a time
  constexpr double bytes = 600, numbered = 715827882;  // half-edges are numbered by int
  double memory =
      static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    memory = std::min(memory, static_cast<double>(limit.rlim_cur));
  return std::min(numbered, memory / bytes);
}

int run_tool(int argc, char** argv, const char* program, const char* summary,
             const std::function<void(CLI::App&)>& options, const std::function<void(Io&)>& body,
             Usage usage) {
  handle_signals();
  if (usage.passes) {
    ::mallopt(M_MMAP_MAX, 0);
    ::mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  } else {
    // large arrays go back when freed (by default the limit creeps up); small ones are used again, which
    // saves a quarter of the page faults of a surface of 70 000 triangles
    ::mallopt(M_MMAP_THRESHOLD, 8 << 20);
    ::mallopt(M_TRIM_THRESHOLD, 1 << 20);
  }
  Io io;
  io.program = program;
  io.any_size_ = usage.any_size;
  CLI::App app{summary, program};
  app.formatter(std::make_shared<Help>());
  app.get_formatter()->column_width(34);
  app.option_defaults()->group("Options");
  options(app);
  app.option_defaults()->group(common_group);
  if (usage.reads)
    app.add_option("FILE", io.input, "input: the stream or any mesh format; - is standard input")
        ->type_name("");
  app.add_option("-o,--output", io.output, "write to this file instead of standard output")
      ->type_name("FILE");
  auto* ascii = app.add_flag("--ascii", io.ascii, "write text");
  app.add_flag("--binary", io.binary, "write binary")->excludes(ascii);
  app.add_option("-j,--threads", io.threads, "threads; the result does not depend on it")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  app.add_flag("-q,--quiet", io.quiet, "say nothing but errors");
  app.add_flag("-v,--verbose", io.verbose, "say more");
  app.add_option("--json", io.json, "write the report to this file; - is standard output, if -o is not")
      ->type_name("FILE");
  app.set_version_flag("--version", std::string(program) + " " MESHPIPE_VERSION " (mply 1.0)");
  app.get_option("--version")->description("the version, and that of the stream")->group(common_group);
  app.set_help_flag("-h,--help", "this text");
  app.get_option("--help")->group(common_group);

  auto failed = [&](int status, const std::string& why, const std::string& culprit) {
    // the next program in the pipe learns whose failure it is; only the last one repeats it to the user
    const bool pass_on = io.output == "-" && !io.written_ && !::isatty(STDOUT_FILENO);
    // the driver tells what a program failed with, once, unless it can do better: the variable is a file,
    // which must not be another's
    const char* driver = std::getenv("MESHPIPE_DRIVER");
    if (culprit == program || (!driver && !pass_on)) {
      std::FILE* told = driver ? std::fopen(driver, "wx") : nullptr;
      std::fprintf(told ? told : stderr, "%s: error: %s\n", program, why.c_str());
      if (told) std::fclose(told);
    }
    if (pass_on) {
      std::string line = "mply-failed " + culprit + ' ' + std::to_string(status) + '\n';
      (void)!::write(STDOUT_FILENO, line.data(), line.size());
    }
    return status;
  };
  auto show = [&](const std::string& text) {
    try {
      write_all(STDOUT_FILENO, text, "stdout");
      return 0;
    } catch (const CannotWrite& e) {
      return failed(7, e.what(), program);
    }
  };
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return show(app.help());
  } catch (const CLI::CallForVersion& e) {
    return show(std::string(e.what()) + '\n');
  } catch (const CLI::ParseError& e) {
    std::string why = e.what();
    std::replace(why.begin(), why.end(), '\n', ' ');
    if ('A' <= why[0] && why[0] <= 'Z' && why[1] >= 'a') why[0] += 'a' - 'A';
    return failed(2, why + "; see " + program + " --help", program);
  }
  if (io.threads > 0) omp_set_num_threads(io.threads);
  io.arguments_ = recorded(app);
  io.report["program"] = program;

  auto write_report = [&] {
    if (!io.json.empty()) Io::write_file(io.json, io.report.dump(2) + '\n');
  };
  try {
    io.expect_report("-o", io.output, usage.writes_mesh);
    if (!io.json.empty()) io.expect_report("--json", io.json);
    try {
      if (!usage.reads) phase = Phase::working;
      const Progress progress(io);
      body(io);
    } catch (const NotAdmissible&) {
      if (io.report.size() > 1) write_report();  // it had been measured
      throw;
    } catch (const GoalMissed&) {
      write_report();
      throw;
    } catch (const ContractMissed&) {
      write_report();
      throw;
    }
    try {
      write_report();
    } catch (const CannotWrite&) {
      struct stat info {};
      if (::stat(io.finished_.c_str(), &info) == 0 && !in_place(io.finished_, info))
        ::unlink(io.finished_.c_str());
      throw;
    }
    return 0;
  } catch (const UpstreamFailed& e) {
    return failed(e.status, e.program + " failed before this", e.program);
  } catch (const BadUsage& e) {
    return failed(2, e.what(), program);
  } catch (const BadInput& e) {
    return failed(3, e.what(), program);
  } catch (const NotAdmissible& e) {
    return failed(4, e.what(), program);
  } catch (const GoalMissed& e) {
    return failed(5, e.what(), program);
  } catch (const ContractMissed& e) {
    return failed(6, e.what(), program);
  } catch (const CannotWrite& e) {
    return failed(7, e.what(), program);
  } catch (const std::bad_alloc&) {
    return failed(1, "out of memory", program);
  } catch (const std::exception& e) {
    return failed(1, e.what(), program);
  }
}

}  // namespace meshpipe
