# SPDX-License-Identifier: BSD-3-Clause
"""Counts lines of functions, members of classes, lines of comments and `opposite` parameters in C++.

A scanner, not a compiler: it follows brackets in text formatted by clang-format, and recognizes classes, functions and blocks only.
"""
import re

COMMENT_OR_STRING = re.compile(
    r'//[^\n]*|/\*.*?\*/|(?<![0-9a-zA-Z_])(?:u8|[uUL])?R"([^()\\ ]{0,16})\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|'
    r"(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'", re.S)
TOKEN = re.compile(r"[A-Za-z_]\w*|[0-9][\w.']*|::|->|&&|\|\||[-+*/<>=!]=|\S")
OPPOSITE = re.compile(r"(?:vector<int>|span<(?:const )?int>|\bint|\bauto)\s*(?:const\s*)?[&*]*\s*"
                      r"(?:\w*opposites?|\w*opposite_\w+|opp)(?=\s*(?:[,)]|=))")


def blank(text):
    """Returns the text with comments, the contents of strings, and preprocessor lines replaced by blanks."""
    def cover(found):
        kept = re.sub(r"[^\n]", " ", found[0])
        return kept if found[0].startswith("/") else '"' + kept[1:-1] + '"'
    text = COMMENT_OR_STRING.sub(cover, text)
    return re.sub(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", lambda m: re.sub(r"[^\n]", " ", m[0]), text, flags=re.M)


class Scanner:
    """Tokens of a text, and what was found in it: functions and classes as (line, name, size)."""

    def __init__(self, text):
        plain = blank(text)
        self.tokens, self.lines = [], []
        line, last = 1, 0
        for found in TOKEN.finditer(plain):
            line += plain.count("\n", last, found.start())
            last = found.start()
            self.tokens.append(found[0])
            self.lines.append(line)
        self.at = 0
        self.functions, self.classes = [], []

    def scope(self, kind):
        """Scans to the bracket that closes the scope, and past it. Returns the number of members of a class."""
        members = 0
        statement = []  # indices of tokens since the last statement ended; bodies are left out
        depth = 0  # of round and square brackets
        while self.at < len(self.tokens):
            i, token = self.at, self.tokens[self.at]
            self.at += 1
            if token == "}" and depth == 0:
                break
            if token in "([":
                depth += 1
            elif token in ")]":
                depth -= 1
            if token == "{":
                ended, found = self.brace(kind, statement, i, depth)
                members += found
                if ended:
                    statement = []
                else:
                    statement.append(i)  # stands for the whole {...}
            elif token == ";" and depth == 0:
                if kind == "class":
                    members += self.declared([self.tokens[k] for k in statement])
                statement = []
            elif token == ":" and kind == "class" and len(statement) == 1 and \
                    self.tokens[statement[0]] in ("public", "private", "protected"):
                statement = []
            else:
                statement.append(i)
        return members

    def brace(self, kind, statement, i, depth):
        """Scans what the bracket at token i opens. Returns whether it ends the statement, and the members it declares."""
        words = [self.tokens[k] for k in statement]
        start = self.lines[statement[0]] if statement else self.lines[i]
        if depth > 0 or kind == "block":
            head = without_template(words)
            if depth == 0 and head[:1] and head[0] in ("struct", "class", "union") and "(" not in head and "=" not in head:
                self.a_class(head, start)
                return False, 0
            self.scope("block")
            # the end of a block ends its statement, that of an initializer or a lambda does not
            return depth == 0 and not ends_with_value(words), 0
        head = without_template(words)
        if "namespace" in head[:2] or head[:1] == ["extern"] and "(" not in head:
            self.scope("namespace")
            return True, 0
        if "enum" in head[:2]:
            self.scope("block")
            return False, 0
        keyword = next((k for k, w in enumerate(head) if w in ("struct", "class", "union")), None)
        if keyword is not None and "(" not in strip_attributes(head) and "=" not in head:
            self.a_class(head[keyword:], start)
            return False, 0
        if is_function(head):
            if in_initializers(head):
                self.scope("block")
                return False, 0
            self.scope("block")
            self.functions.append((start, function_name(head), self.lines[self.at - 1] - start + 1))
            return True, int(kind == "class")
        self.scope("block")
        return False, 0

    def a_class(self, head, start):
        name = "".join(w for w in head[1:(head.index(":") if ":" in head else None)] if w != "final")
        self.classes.append((start, name, self.scope("class")))

    @staticmethod
    def declared(words):
        """Returns the number of data members or functions that a statement of a class declares."""
        words = without_template(words)
        if not words or words[0] in ("using", "typedef", "friend", "static_assert", "enum", "{"):
            return 0
        if words[0] in ("struct", "class", "union"):
            if "{" not in words:
                # a forward declaration, or a member with that word before its type
                return int(len([w for w in words if w != "::"]) > 2 and ":" not in words)
            words = words[words.index("{") + 1:]
            return 0 if not words else 1 + words.count(",")
        if is_function(words):
            return 1
        commas, angle, depth, previous = 0, 0, 0, ""
        for w in words:
            if w in "([":
                depth += 1
            elif w in ")]":
                depth -= 1
            elif w == "<" and re.match(r"[A-Za-z_]", previous):
                angle += 1
            elif w == ">" and angle:
                angle -= 1
            elif w == "," and depth == 0 and angle == 0:
                commas += 1
            previous = w
        return 1 + commas


def strip_attributes(words):
    """Leaves out alignas(...) and __attribute__((...))."""
    result, depth, skipping = [], 0, False
    for w in words:
        if w in ("alignas", "__attribute__"):
            skipping = True
            continue
        if skipping:
            depth += (w == "(") - (w == ")")
            skipping = depth > 0
            continue
        result.append(w)
    return result


def without_template(words):
    """Leaves out leading template <...> and requires-less attributes [[...]]."""
    while words[:2] == ["template", "<"]:
        angle, depth, k = 0, 0, 1
        while k < len(words):
            depth += (words[k] in "([{") - (words[k] in ")]}")
            angle += (words[k] == "<" and depth == 0) - (words[k] == ">" and depth == 0)
            k += 1
            if angle == 0:
                break
        words = words[k:]
    if words[:2] == ["[", "["]:
        words = words[words.index("]") + 2:]
    return words


def first_parenthesis(words):
    """Returns the index of the first ( outside template arguments, or None; with an = before it there is none."""
    angle, previous = 0, ""
    for k, w in enumerate(words):
        if previous == "operator":
            previous = ""
            # operator() has its parameters after that
            continue
        if w == "<" and re.match(r"[A-Za-z_]", previous):
            angle += 1
        elif w == ">" and angle:
            angle -= 1
        elif w == "=" and not angle:
            return None
        elif w == "(" and not angle and not (k and words[k - 1] == ")" and words[k - 2] != "(") and \
                previous not in ("alignas", "decltype", "noexcept", "explicit"):
            return k
        previous = w
    return None


def is_function(words):
    k = first_parenthesis(words)
    return k is not None and k > 0 and (re.match(r"[A-Za-z_]", words[k - 1]) is not None or "operator" in words[:k])


def function_name(words):
    k = first_parenthesis(words)
    start = k - 1
    if "operator" in words[:k]:
        return "operator" + "".join(words[words.index("operator") + 1:k])
    if words[start] in ("TEST", "TEST_F", "TEST_P"):
        return "".join(words[start:words.index(")") + 1])
    while start > 1 and words[start - 1] in ("::", "~"):
        start -= 1 if words[start - 1] == "~" else 2
    return "".join(words[start:k])


def in_initializers(words):
    """Whether the { after these words initializes a member in a constructor's list: ...) : a_{ or ...), b_{."""
    k, depth = first_parenthesis(words), 0
    while k < len(words):
        depth += (words[k] == "(") - (words[k] == ")")
        k += 1
        if depth == 0:
            break
    return ":" in words[k:] and re.match(r"[A-Za-z_]|>", words[-1]) is not None


def ends_with_value(words):
    """Whether the { after these words, in a function, is a value or a lambda's body: its statement goes on after it."""
    if not words or words[0] in ("for", "if", "while", "do", "else", "switch", "try", "catch", "case", "default"):
        return False
    return True


def comments(text):
    """Returns (line, first words, number of lines) of every block of comment lines that stands before a declaration, the
    file's own description left out; and of descriptions behind a member."""
    result = []
    lines = text.split("\n")
    k = 0
    while k < len(lines):
        start = k
        while k < len(lines) and re.match(r"\s*//", lines[k]):
            k += 1
        if k > start:
            follows = lines[k].strip() if k < len(lines) else ""
            begun = start > 0 and re.search(r"\S\s+///?<", lines[start - 1]) is not None
            if begun or follows and not follows.startswith(("#", "}")):
                result.append((start + (0 if begun else 1), lines[start].strip()[:60], k - start + begun))
        else:
            k += 1
    return result


def without_verb(text):
    """Returns (line, first words, 1) of each `///` comment on a function that does not begin with a verb, such as "Returns"."""
    result = []
    for found in re.finditer(r"^([ \t]*)/// (.*)\n(?:\1///.*\n)*(?! *//)", text, re.M):
        rest = re.split(r"[;{]", text[found.end():found.end() + 1000])[0]
        words = without_template(TOKEN.findall(blank(rest)))
        if not words or words[0] in ("struct", "class", "enum", "using", "namespace") or "function" in words or not is_function(words):
            continue
        if not re.match(r"(?!Has |Does |Was |Its |This )[A-Z][a-z]+s\b", found[2]):
            result.append((text.count("\n", 0, found.start()) + 1, found[2][:60], 1))
    return result


def opposite_parameters(text):
    """Returns (line, text) of each parameter that is the column of opposite half-edges."""
    plain = blank(text)
    brackets, opened = [], {}
    wanted = {m.start(): m[0] for m in OPPOSITE.finditer(plain)}
    for k, c in enumerate(plain):
        if k in wanted:
            opened[k] = brackets[-1] if brackets else -1
        if c in "([{":
            brackets.append(k)
        elif c in ")]}" and brackets:
            brackets.pop()
    result = []
    for k, found in wanted.items():
        o = opened[k]
        if o < 0 or plain[o] != "(" or re.search(r"\b(?:for|if|while|switch)\s*$", plain[:o]):
            continue
        result.append((plain.count("\n", 0, k) + 1, " ".join(found.split()), 1))
    return result


def facts(text):
    """Returns what is found in the text of one file: functions, classes, comments, opposite and verbs, each a list of (line,
    name, size)."""
    scanner = Scanner(text)
    scanner.scope("namespace")
    return {"functions": scanner.functions, "classes": scanner.classes, "comments": comments(text),
            "opposite": opposite_parameters(text), "verbs": without_verb(text)}
