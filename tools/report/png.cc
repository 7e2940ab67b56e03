// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/png.h"

#include <png.h>

#include "lib/core/error.h"

namespace meshpipe {

std::string write_png(const Image& image) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = image.width;
  png.height = image.height;
  png.format = PNG_FORMAT_RGB;
  png_alloc_size_t bytes = 0;
  std::string out;
  if (png_image_write_to_memory(&png, nullptr, &bytes, 0, image.rgb.data(), 0, nullptr)) {
    out.resize(bytes);
    if (png_image_write_to_memory(&png, out.data(), &bytes, 0, image.rgb.data(), 0, nullptr)) {
      out.resize(bytes);
      return out;
    }
  }
  throw CannotWrite(std::string("png: ") + png.message);
}

}  // namespace meshpipe
