// SPDX-License-Identifier: BSD-3-Clause
// Sizes that come in a file of their own: another mesh with data, or a table of points.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "formats/stream.h"
#include "lib/bvh.h"

namespace meshpipe {

/// Points with a size each, and triangles between them on which it is linear; a point that is in no triangle
/// of the file is one by itself (three equal corners).
struct SizeField : Mesh {
  std::vector<double> size;
};

/// The vertex column `column` of a mesh; if that is empty, `size`, `h` or the only one. Throws BadInput
/// naming the columns there are, or a value that is not positive.
SizeField size_field_of(const Stream& mesh, const std::string& column, const std::string& where);

/// True for a text whose first row that is no comment, or its second after a line of names, begins with
/// numbers.
bool is_size_table(std::string_view bytes);
/// Rows of x y z h, parted by blanks, commas or semicolons; what follows # in a line is skipped, and so is a
/// first line without a number: names of the columns. Throws BadInput with the line, of a row that has other
/// than four values too.
SizeField read_size_table(std::string_view bytes, const std::string& where);

/// The size at the nearest point of the field; where sheets of it are as good as equally near, the smallest.
/// `tree`: of the field.
double size_near(const SizeField& field, const Bvh& tree, Vec3 p);

}  // namespace meshpipe
