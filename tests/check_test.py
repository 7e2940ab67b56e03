#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/check counts right: functions, classes, comments, parameters and words of small texts whose figures are known.

usage: tests/check_test.py
"""
import importlib.machinery
import importlib.util
import os
import sys
import unittest

sys.dont_write_bytecode = True
SCRIPTS = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "scripts")
sys.path.insert(0, SCRIPTS)
loader = importlib.machinery.SourceFileLoader("check", os.path.join(SCRIPTS, "check"))
check = importlib.util.module_from_spec(importlib.util.spec_from_loader("check", loader))
loader.exec_module(check)
from checks import source  # noqa: E402


def functions(text):
    return {name: size for _, name, size in source.facts(text)["functions"]}


def classes(text):
    return {name: size for _, name, size in source.facts(text)["classes"]}


class Functions(unittest.TestCase):
    def test_counts_from_the_first_line_of_the_head_to_the_bracket(self):
        self.assertEqual(functions("int f(int a,\n      int b) {\n  return a;\n}\n"), {"f": 4})
        self.assertEqual(functions("int one() { return 1; }"), {"one": 1})
        self.assertEqual(functions("template <class T, int n = (1 < 2)>\nstd::vector<T> g(T x) {\n}\n"), {"g": 3})

    def test_members_in_and_out_of_the_class(self):
        self.assertEqual(functions("struct A {\n  int f() const {\n    return 1;\n  }\n};\nint A::g() {\n}\n"), {"f": 3, "A::g": 2})
        self.assertEqual(functions("A::~A() {\n}\nbool A::operator()(int x) const {\n}\nbool operator<(A a, A b) {\n}"),
                         {"A::~A": 2, "operator()": 2, "operator<": 2})

    def test_initializers_of_a_constructor_belong_to_it(self):
        self.assertEqual(functions("A::A(int x)\n    : a_(x), b_{1, 2},\n      c_(3) {\n  go();\n}\nvoid next() {\n}"),
                         {"A::A": 5, "next": 2})

    def test_lambdas_blocks_and_values_belong_to_their_function(self):
        text = """void f() {
  auto g = [&](int x) {
    return x;
  };
  for (int i = 0; i < 3; ++i) {
  }
  std::sort(a, b, [](int x, int y) { return x < y; });
  const std::vector<int> v{1, 2};
}
"""
        self.assertEqual(functions(text), {"f": 9})

    def test_values_and_declarations_are_none(self):
        self.assertEqual(functions("const int table[] = {1, 2};\nint f(int);\nconstexpr auto g = [](int x) { return x; };\n"
                                   "std::vector<int> v{1};\nenum class E { a, b };\n"), {})

    def test_comments_strings_and_macros_do_not_count(self):
        self.assertEqual(functions('#define F(x) \\\n  { x\n// void a() {\nconst char* s = "void b() {";\n'
                                   'const char c = \'{\';\nauto r = R"(void c() {)";\nint n = 1\'000;\nvoid d() {\n}\n'), {"d": 2})

    def test_after_extern_c_and_in_namespaces(self):
        self.assertEqual(functions('extern "C" void f(int s) {\n}\nnamespace a::b {\nnamespace {\nint g() {\n}\n}\n}\nint h() {\n}'),
                         {"f": 2, "g": 2, "h": 2})

    def test_tests_are_functions(self):
        self.assertEqual(functions("TEST(Suite, case_one) {\n  EXPECT_TRUE(x);\n}\n"), {"TEST(Suite,case_one)": 3})


class Classes(unittest.TestCase):
    def test_counts_each_data_member_and_each_function(self):
        self.assertEqual(classes("struct A {\n  int a, b = 2, c[3];\n  std::map<int, double> d;\n  double e{1};\n  void f(int, int);\n"
                                 "  int g() const { return a < b; }\n};"), {"A": 7})

    def test_leaves_out_what_is_no_member(self):
        self.assertEqual(classes("class A {\n public:\n  using B = int;\n  friend int f(A, A);\n  struct C;\n  enum { x, y };\n"
                                 "  static_assert(true);\n  A();\n private:\n  int n_ = f(1, 2);\n};"), {"A": 2})

    def test_nested_classes_have_their_own(self):
        self.assertEqual(classes("struct A {\n  struct B {\n    int x, y;\n  };\n  std::vector<B> b;\n  struct { int p; } q, r;\n};"),
                         {"A": 3, "B": 2, "": 1})

    def test_functions_as_members_and_base_classes(self):
        self.assertEqual(classes("class A final : public B<int> {\n  std::function<void(int, int)> f;\n  int (*g)(int, int);\n"
                                 "  template <class T>\n  T h(T x) const;\n  A(const A&) = delete;\n  bool operator()(int) const;\n"
                                 "  explicit operator bool() const;\n};"), {"A": 6})

    def test_within_a_function(self):
        self.assertEqual(classes("void f() {\n  struct Item {\n    int a, b;\n  };\n  std::vector<Item> items;\n}"), {"Item": 2})


class Parameters(unittest.TestCase):
    def count(self, text):
        return len(source.facts(text)["opposite"])

    def test_parameters_count(self):
        self.assertEqual(self.count("void f(const Mesh& m, const std::vector<int>& opposite);"), 1)
        self.assertEqual(self.count("void f(std::span<const int> opposite, int n) {}\nvoid g(std::vector<int>* opposite = nullptr);"), 2)
        self.assertEqual(self.count("A::A(std::vector<int> opposite) {}\nauto f = [](const std::vector<int>& opp) {};"), 2)

    def test_others_do_not(self):
        self.assertEqual(self.count("struct A {\n  std::vector<int> opposite;\n};\nvoid f() {\n  std::vector<int> opposite, other;\n"
                                    "  const std::vector<int> opposite = g(1);\n  for (int opposite = 0; opposite < 3;) {\n  }\n"
                                    "  g(opposite, 1);\n}\n// f(const std::vector<int>& opposite)\n"), 0)


class Comments(unittest.TestCase):
    def longest(self, text):
        return max((size for _, _, size in source.facts(text)["comments"]), default=0)

    def test_counts_what_stands_before_a_declaration(self):
        self.assertEqual(self.longest("/// a\n/// b\n/// c\nint f();\n"), 3)
        self.assertEqual(self.longest("  int a;  ///< x\n          ///< y\n          ///< z\n  int b;\n"), 3)

    def test_leaves_out_the_description_of_the_file(self):
        self.assertEqual(self.longest("// a\n// b\n#pragma once\n// c\n\nint f();\n"), 0)


class Verbs(unittest.TestCase):
    def count(self, text):
        return len(source.facts(text)["verbs"])

    def test_comments_on_functions_begin_with_one(self):
        self.assertEqual(self.count("/// Returns a.\n/// The rest.\nint f(int a);\n\n/// Adds.\ntemplate <class T>\nvoid g(T t) {\n}\n"), 0)
        self.assertEqual(self.count("/// The sum\n/// Returns it.\nint f(int a);\n"), 1)
        self.assertEqual(self.count("struct A {\n  /// Is it one?\n  bool is() const { return true; }\n};\n"), 1)

    def test_others_need_none(self):
        self.assertEqual(self.count("/// A mesh.\nstruct A {\n  int f();\n};\n/// At (x, y).\nint a = f(1);\n"
                                    "/// A call.\nusing F = std::function<void(int)>;\n"), 0)


class Words(unittest.TestCase):
    def words(self, text, path="lib/a/a.h"):
        return [hit.split("'")[1] for hit in check.word_hits(path, text)]

    def test_finds_words_in_text_and_in_names(self):
        self.assertCountEqual(self.words("// the user is told\nint reach_tips(TipList a);\nint tipsy, antips;"),
                              ["told", "tips", "Tip"])

    def test_finds_words_across_lines(self):
        self.assertEqual(self.words("/// parted\n  /// by it"), ["parted\n  /// by"])
        self.assertEqual(self.words("# so\n# many"), ["so\n# many"])

    def test_knows_exceptions(self):
        self.assertEqual(self.words("cells", "formats/vtk_xml.cc"), [])
        self.assertEqual(self.words("no room for it"), [])
        self.assertEqual(self.words("the room at a vertex"), ["room"])


class Includes(unittest.TestCase):
    def test_direction_and_headers(self):
        sources = {"lib/core/a.h": '#include "lib/relax/relax.h"\n#include <Eigen/Core>\n', "lib/relax/relax.h": "",
                   "lib/relax/x.cc": '#include "lib/core/a.h"\n#include "lib/lift/inner.h"\n', "lib/lift/inner.h": "",
                   "lib/param/param.h": '#include "lib/partition/partition.h"\n', "lib/numeric/n.cc": "#include <Eigen/Core>\n"}
        against, inner, eigen, cutting, missing = check.include_figures(sources)
        self.assertEqual([len(x) for x in (against, inner, eigen, cutting, missing)], [2, 1, 1, 1, 1])
        self.assertIn("lib/lift", missing[0])


if __name__ == "__main__":
    unittest.main()
