// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/end_names.h"

#include "formats/text.h"

namespace meshpipe {

std::vector<EndName> read_end_names(std::string_view bytes, const std::string& where) {
  Text text(bytes, where, '#');
  std::vector<EndName> names;
  std::vector<std::size_t> lines;
  while (text.next_line()) {
    EndName name;
    name.text = text.word();
    for (std::size_t i = 0; i < names.size(); ++i)
      if (names[i].text == name.text)
        text.fail("name " + quoted(name.text) + " again, which line " + std::to_string(lines[i]) + " has");
    if (!text.line_ends()) {
      name.placed = true;
      name.place = {text.number("x"), text.number("y"), text.number("z")};
      if (!text.line_ends())
        text.fail("expected NAME or NAME X Y Z, found " + quoted(text.word()) + " after z");
    }
    names.push_back(name);
    lines.push_back(text.line());
  }
  if (names.empty()) text.fail("no names");
  return names;
}

}  // namespace meshpipe
