#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes completions for bash, zsh and fish of every program, from its --help.

usage: completions.py BIN_DIR OUT_DIR      writes OUT_DIR/bash/NAME, OUT_DIR/zsh/_NAME, OUT_DIR/fish/NAME.fish
"""
import os
import re
import subprocess
import sys

OPTION = re.compile(r"(?<![\w-])(-[a-zA-Z]|--[a-z][a-z0-9-]*)(?: ([A-Z][^ ,;:]*|[^ ]*\|[^ ]*|\d))?(?=[ ,;:]|$)")
ALIAS = re.compile(r"(-[a-zA-Z]), ?(--[a-z])")


class Option:
    """One option: its names, its value ("" for a flag), the words it may have, and what it does."""

    def __init__(self, name, value, what):
        self.names, self.value, self.what = [name], value, what
        plain = re.fullmatch(r"[a-z0-9-]+(\|[a-z0-9-]+)+", value)
        self.words = value.split("|") if plain else []

    def takes_file(self):
        return bool(re.match(r"FILE|DIR|IN\b|OUT\b", self.value))


def options_of(text):
    """Returns the options in the text of --help: lines that begin with two blanks and a dash, and their continuations."""
    options = []
    for line in re.sub(r"\n {10,}", "  ", text).splitlines():
        if not line.startswith("  -"):
            continue
        head, _, what = line.strip().partition("  ")
        what = " ".join(what.split())
        short = None
        for name, value in OPTION.findall(re.sub(r"(-[a-zA-Z]),(--)", r"\1, \2", head)):
            if short and not name.startswith("--"):
                options.append(Option(short, "", ""))
                short = None
            if not name.startswith("--") and not value and ALIAS.search(head, head.find(name)):
                short = name
                continue
            options.append(Option(name, value, what if "," not in head.replace(",-", "") else ""))
            if short:
                options[-1].names.insert(0, short)
                short = None
    return options


def quoted(text):
    return "'" + text.replace("'", "'\\''") + "'"


def bash(program, options):
    out = f"# completion of {program} for bash, made from its --help\n_{program}() {{\n  local cur=${{COMP_WORDS[COMP_CWORD]}}\n"
    out += "  case ${COMP_WORDS[COMP_CWORD - 1]} in\n"
    for o in options:
        if o.words:
            out += f"    {' | '.join(o.names)}) mapfile -t COMPREPLY < <(compgen -W {quoted(' '.join(o.words))} -- \"$cur\"); return ;;\n"
        elif o.value and not o.takes_file():
            out += f"    {' | '.join(o.names)}) COMPREPLY=(); return ;;\n"
    names = " ".join(n for o in options for n in o.names)
    files = [n for o in options if o.takes_file() for n in o.names]
    if files:
        out += f"    {' | '.join(files)}) compopt -o filenames; mapfile -t COMPREPLY < <(compgen -f -- \"$cur\"); return ;;\n"
    out += f"""  esac
  if [[ $cur == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W {quoted(names)} -- "$cur")
  else
    compopt -o filenames
    mapfile -t COMPREPLY < <(compgen -f -- "$cur")
  fi
}}
complete -F _{program} {program}
"""
    return out


def zsh(program, options):
    out = f"#compdef {program}\n# made from its --help\n_arguments -s \\\n"
    for o in options:
        what = re.sub(r"([\[\]:\\])", r"\\\1", o.what)
        value = f":{o.value.split('|')[0].lower()}:" if o.value else ""
        value = re.sub(r"[\[\],]", "", value)
        if o.value:
            value += "(" + " ".join(o.words) + ")" if o.words else "_files" if o.takes_file() else " "
        for n in o.names:
            out += f"  {quoted(f'{n}[{what}]{value}')} \\\n"
    return out + "  '*:file:_files'\n"


def fish(program, options):
    out = f"# completion of {program} for fish, made from its --help\n"
    for o in options:
        names = " ".join(("-l " + n[2:]) if n.startswith("--") else "-s " + n[1:] for n in o.names)
        value = f" -x -a {quoted(' '.join(o.words))}" if o.words else " -r -F" if o.takes_file() else " -x" if o.value else ""
        out += f"complete -c {program} {names}{value} -d {quoted(o.what)}\n"
    return out


def stages_of(driver):
    """Returns the names of the stages that the driver chains, in its lists of them."""
    with open(driver, encoding="utf-8") as f:
        lists = re.findall(r"\bstages=\(([a-z0-9 ]+)", f.read())
    return list(dict.fromkeys(stage for names in lists for stage in names.split()))


def main(bin_dir, out_dir):
    programs = sorted(p for p in os.listdir(bin_dir) if re.fullmatch(r"m[a-z0-9]+", p))
    known = {}
    for p in programs:
        text = subprocess.run([os.path.join(bin_dir, p), "--help"], capture_output=True, text=True, check=True).stdout
        known[p] = options_of(text)
    words = {n: o.words for p, options in known.items() if p != "mshape" for o in options if o.words for n in o.names}
    for p, options in known.items():
        for o in options if p == "mremesh" else []:  # its options are those of the stages
            if o.value == "STAGE":
                o.words = stages_of(os.path.join(bin_dir, p))
            elif not o.takes_file():
                o.words = o.words or words.get(o.names[-1], [])
        for shell, name, make in (("bash", p, bash), ("zsh", "_" + p, zsh), ("fish", p + ".fish", fish)):
            folder = os.path.join(out_dir, shell)
            os.makedirs(folder, exist_ok=True)
            with open(os.path.join(folder, name), "w", encoding="utf-8") as f:
                f.write(make(p, options))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2])
