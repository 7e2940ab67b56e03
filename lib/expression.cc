// SPDX-License-Identifier: BSD-3-Clause
#include "lib/expression.h"

#include <muParser.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <numbers>

#include "lib/error.h"

namespace meshpipe {

namespace {

/// Where the text has a = that is not part of == != <= >=, or npos.
std::size_t assignment(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    if (i + 1 < text.size() && text[i + 1] == '=')
      ++i;
    else if (i == 0 || (text[i - 1] != '!' && text[i - 1] != '<' && text[i - 1] != '>'))
      return i;
  }
  return std::string::npos;
}

}  // namespace

struct Expression::Impl {
  mu::Parser parser;
  std::vector<double> values;
};

Expression::Expression(const std::string& text, const std::vector<std::string>& variables)
    : impl_(std::make_unique<Impl>()) {
  impl_->values.assign(variables.size(), 1);
  try {
    impl_->parser.DefineConst("pi", std::numbers::pi);
    impl_->parser.DefineConst("inf", std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < variables.size(); ++i)
      impl_->parser.DefineVar(variables[i], &impl_->values[i]);
    if (const std::size_t at = assignment(text); at != std::string::npos)
      throw BadUsage("expression '" + text + "': assigns a value at position " + std::to_string(at + 1) +
                     "; == compares");
    impl_->parser.SetExpr(text);
    int results = 0;
    impl_->parser.Eval(results);
    if (results != 1)
      throw BadUsage("expression '" + text + "' has " + std::to_string(results) + " values, one is due");
  } catch (const mu::Parser::exception_type& e) {
    std::string why = e.GetMsg();
    if (!why.empty()) why[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(why[0])));
    if (why.ends_with('.')) why.pop_back();
    throw BadUsage("expression '" + text + "': " + why);
  }
}

Expression::~Expression() = default;

bool Expression::uses(const std::string& variable) const {
  return impl_->parser.GetUsedVar().contains(variable);
}

double Expression::operator()(const std::vector<double>& values) {
  std::copy(values.begin(), values.end(), impl_->values.begin());
  try {
    return impl_->parser.Eval();
  } catch (const mu::Parser::exception_type&) {  // a division by zero, where the library is built to say so
    return std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace meshpipe
