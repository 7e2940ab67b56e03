// SPDX-License-Identifier: BSD-3-Clause
// Formulas that users write, by the muParser library.
#pragma once
#include <memory>
#include <string>
#include <vector>

namespace meshpipe {

/// A formula of named variables: + - * / ^, comparisons, a ? b : c, min, max, sqrt, exp, ln, sin and the
/// like, pi. Not for several threads at once.
class Expression {
 public:
  /// Throws BadUsage saying what is wrong and where; an assignment is wrong.
  Expression(const std::string& text, const std::vector<std::string>& variables);
  ~Expression();
  Expression(const Expression&) = delete;
  Expression& operator=(const Expression&) = delete;
  /// Whether the formula reads this variable.
  bool uses(const std::string& variable) const;
  /// The value for values of the variables in their order; NaN and infinity where the formula gives them.
  double operator()(const std::vector<double>& values);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meshpipe
