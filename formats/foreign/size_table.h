// SPDX-License-Identifier: BSD-3-Clause
// Size fields in files: the vertex data of a mesh, or a table of points.
#pragma once
#include <string>
#include <string_view>

#include "formats/stream.h"
#include "lib/size/size.h"

namespace meshpipe {

/// Makes a size field of the vertex column `column`; if that is "", of `size`, `h` or the only column.
/// `where`: the file's name for messages. Throws: BadInput naming the columns there are, or the vertex whose
/// value is not positive.
SizeField size_field_of(const Stream& mesh, const std::string& column, const std::string& where);

/// Returns whether a text is a table: its first row, or its second after a line of names, begins with
/// numbers.
bool is_size_table(std::string_view bytes);
/// Reads rows of x y z h, separated by blanks, commas or semicolons. Comments run from # to the end of a
/// line; a first line without a number names the columns. Throws: BadInput with the line of a row that is not
/// four values with a positive size, or if `column` is not "" and not the name of the fourth.
SizeField read_size_table(std::string_view bytes, const std::string& column, const std::string& where);

}  // namespace meshpipe
