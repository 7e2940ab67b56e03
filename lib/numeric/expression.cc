// SPDX-License-Identifier: BSD-3-Clause
#include "lib/numeric/expression.h"

#include <muParserDLL.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <numbers>

#include "lib/core/error.h"

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

// by muParser's C interface, which any C++ library can be linked with
struct Expression::Impl {
  muParserHandle_t parser = mupCreate(muBASETYPE_FLOAT);
  std::vector<double> values;
  ~Impl() { mupRelease(parser); }
};

Expression::Expression(const std::string& text, const std::vector<std::string>& variables)
    : impl_(std::make_unique<Impl>()) {
  const muParserHandle_t parser = impl_->parser;
  auto expect_no_error = [&] {
    if (!mupError(parser)) return;
    std::string why = mupGetErrorMsg(parser);
    if (!why.empty()) why[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(why[0])));
    if (why.ends_with('.')) why.pop_back();
    throw BadUsage("expression '" + text + "': " + why);
  };
  impl_->values.assign(variables.size(), 1);
  mupDefineConst(parser, "pi", std::numbers::pi);
  mupDefineConst(parser, "inf", std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < variables.size(); ++i)
    mupDefineVar(parser, variables[i].c_str(), &impl_->values[i]);
  if (const std::size_t at = assignment(text); at != std::string::npos)
    throw BadUsage("expression '" + text + "': assigns a value at position " + std::to_string(at + 1) +
                   "; == compares");
  mupSetExpr(parser, text.c_str());
  expect_no_error();
  int results = 0;
  mupEvalMulti(parser, &results);
  expect_no_error();
  if (results != 1)
    throw BadUsage("expression '" + text + "' has " + std::to_string(results) + " values, expected one");
}

Expression::~Expression() = default;

bool Expression::uses(const std::string& variable) const {
  const int n = mupGetExprVarNum(impl_->parser);
  for (int i = 0; i < n; ++i) {
    const muChar_t* name;
    muFloat_t* value;
    mupGetExprVar(impl_->parser, static_cast<unsigned>(i), &name, &value);
    if (variable == name) return true;
  }
  return false;
}

double Expression::operator()(const std::vector<double>& values) {
  std::copy(values.begin(), values.end(), impl_->values.begin());
  const double value = mupEval(impl_->parser);
  if (!mupError(impl_->parser)) return value;
  mupErrorReset(impl_->parser);  // a division by zero, where the library is built to say so
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace meshpipe
