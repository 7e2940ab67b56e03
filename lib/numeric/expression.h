// SPDX-License-Identifier: BSD-3-Clause
// Formulas that users write, by the muParser library.
#pragma once
#include <memory>
#include <string>
#include <vector>

namespace meshpipe {

/// A formula of named variables: + - * / ^, comparisons, a ? b : c, min, max, sqrt, exp, ln, sin and the
/// like, pi. Not to be used from several threads at once.
class Expression {
 public:
  /// Parses a formula. Throws: BadUsage saying what is wrong and where; an assignment is wrong.
  Expression(const std::string& text, const std::vector<std::string>& variables);
  ~Expression();
  Expression(const Expression&) = delete;
  Expression& operator=(const Expression&) = delete;
  /// Returns whether the formula contains this variable.
  bool uses(const std::string& variable) const;
  /// Returns the value for values of the variables, in their order; it may be NaN or infinite.
  double operator()(const std::vector<double>& values);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meshpipe
