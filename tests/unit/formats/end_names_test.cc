// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/end_names.h"

#include <gtest/gtest.h>

#include "lib/core/error.h"

using namespace meshpipe;

namespace {

std::string why(std::string_view text) {
  try {
    read_end_names(text, "names");
  } catch (const BadInput& e) {
    return e.what();
  }
  return "";
}

TEST(end_names, reads_names_with_and_without_places) {
  const std::vector<EndName> names = read_end_names("# ends\naorta\nleft 1 -2.5 3e2  # carotid\r\n", "names");
  ASSERT_EQ(names.size(), 2u);
  EXPECT_EQ(names[0].text, "aorta");
  EXPECT_FALSE(names[0].placed);
  EXPECT_TRUE(names[1].placed);
  EXPECT_TRUE((names[1].place == Vec3{1, -2.5, 300}));
}

TEST(end_names, refuses_other_lines) {
  EXPECT_EQ(why("a\na 1 2 3\n"), "names:2: name 'a' again, which line 1 has");
  EXPECT_NE(why("a 1 2\n"), "");
  EXPECT_NE(why("a 1 2 x\n"), "");
  EXPECT_EQ(why("a 1 2 3 4\n"), "names:1: expected NAME or NAME X Y Z, found '4' after z");
  EXPECT_NE(why("# nothing\n"), "");
}

}  // namespace
