// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/number.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string_view>

using namespace meshpipe;

namespace {

struct Result {
  double value = -1;
  std::size_t length;
  std::errc error;
};
Result read(std::string_view text) {
  Result r;
  const auto [end, error] = from_chars(text.data(), text.data() + text.size(), r.value);
  r.length = end - text.data();
  r.error = error;
  return r;
}

}  // namespace

TEST(Number, IsReadUpToItsEnd) {
  EXPECT_EQ(read("1.5,2").value, 1.5);
  EXPECT_EQ(read("1.5,2").length, 3u);
  EXPECT_EQ(read("-2e-3").value, -2e-3);
  EXPECT_EQ(read("0x10").length, 1u);
  EXPECT_EQ(read("7%").value, 7);
  EXPECT_TRUE(std::isnan(read("nan").value));
}

TEST(Number, OthersAreRefused) {
  for (const char* text : {"", "+1", " 1", "x", "-"})
    EXPECT_EQ(read(text).error, std::errc::invalid_argument) << text;
  EXPECT_EQ(read("1e999").error, std::errc::result_out_of_range);
  EXPECT_EQ(read("1e999").length, 5u);
}
