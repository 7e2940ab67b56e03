// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/gzip.h"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "lib/core/error.h"

namespace meshpipe {
namespace {

constexpr std::size_t most = std::size_t(1) << 32;  ///< bytes: larger files should not come compressed
constexpr std::size_t chunk = 1 << 20;              ///< bytes unpacked at a time

}  // namespace

bool is_gzip(std::string_view bytes) { return bytes.starts_with("\x1f\x8b"); }

std::string unzip(std::string_view bytes, const std::string& where) {
  auto fail = [&](std::size_t byte, const char* what) {
    throw BadInput(where + ':' + std::to_string(byte) + ": the gzip file " + what);
  };
  z_stream z{};
  constexpr int gzip_only = 16 + MAX_WBITS;
  if (inflateInit2(&z, gzip_only) != Z_OK) fail(1, "cannot be unpacked: there is no memory");
  const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&z, inflateEnd);
  std::string out;
  std::size_t used = 0, made = 0;
  for (int status = Z_OK; used < bytes.size() || status == Z_OK;) {
    if (status == Z_STREAM_END) {  // what follows the last member is no part of it
      if (!is_gzip(bytes.substr(used))) break;
      inflateReset(&z);
    }
    if (made + chunk > most) fail(used, "unpacks to more than 4 GiB: give the unpacked file");
    out.resize(std::max(out.size(), made + chunk));
    z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data())) + used;
    z.avail_in = (uInt)std::min<std::size_t>(bytes.size() - used, std::numeric_limits<uInt>::max());
    z.next_out = reinterpret_cast<Bytef*>(out.data()) + made;
    z.avail_out = (uInt)chunk;
    status = inflate(&z, Z_NO_FLUSH);
    used = (std::size_t)(reinterpret_cast<const char*>(z.next_in) - bytes.data());
    made += chunk - z.avail_out;
    if (status == Z_BUF_ERROR || (status == Z_OK && used == bytes.size() && z.avail_out > 0))
      fail(used, "ends early");
    if (status != Z_OK && status != Z_STREAM_END) fail(used, "is damaged before this byte");
  }
  out.resize(made);
  return out;
}

}  // namespace meshpipe
