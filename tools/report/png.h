// SPDX-License-Identifier: BSD-3-Clause
// Pictures as PNG, by libpng.
#pragma once
#include <string>

#include "lib/draw/draw.h"

namespace meshpipe {

std::string write_png(const Image& image);

}  // namespace meshpipe
