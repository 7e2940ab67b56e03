# SPDX-License-Identifier: BSD-3-Clause
"""What scripts/check holds the source to: the order of modules, words, and limits."""

# A file may include headers of its own module and of those before it.
MODULES = ["core", "numeric", "solids", "resolve", "clean", "wrap", "smooth", "cap", "feature", "defeature", "param", "partition",
           "multiscale", "plan", "size", "lines", "mesh2d", "lift", "relax", "check", "shape", "draw", "formats", "tools"]
# modules without one header of their own: each of theirs is for everybody
TOOLBOXES = ["core", "numeric", "formats", "tools"]
# modules that decide where the surface is cut into parts
CUTTING = ["partition", "multiscale", "plan"]

# name -> (limit, what is counted)
LIMITS = {
    "opposite": (19, "parameters that are a bare column of opposite half-edges"),
    "members": (0, "classes with more than 25 members, data and functions"),
    "functions": (0, "functions of more than 80 lines"),
    "comments": (0, "comments on a declaration of more than 8 lines"),
    "verbs": (0, "comments on a function in a header that do not begin with a verb"),
    "words": (0, "words with a better one in scripts/checks/tables.py"),
    "lib-lines": (40890, "lines in lib/"),
    "cutting-lines": (3798, "lines of the modules that cut: partition, multiscale, plan"),
    "cutting-in-param": (0, "includes of those in lib/param"),
    "eigen": (0, "includes of Eigen outside lib/numeric"),
    "against": (0, "includes against the order of modules"),
    "inner": (0, "includes of a module's inner headers by another"),
    "exceptions": (0, "exceptions to those words that match nothing"),
    "names": (0, "names of classes that two headers give"),
    "modules": (0, "modules without a header of their name, or not in the order"),
    "strays": (0, "files of the repository in other places at its top, as a program left them"),
}

# what the top of the repository holds, other than names with a dot in front
TOP = ["CMakeLists.txt", "LICENSE", "README.md", "formats", "lib", "scripts", "tests", "tools"]

# word -> what to write instead
WORDS = {
    "told": "reported, known", "tells? of": "reports", "due": "expected", "besides": "in addition to",
    "parted by": "separated by", "but for": "except",
    "beside": "next to, adjacent to", "so many": "the number, count", "as good as": "almost", "a row an?": "one row per",
    "tips?": "missed features", "mend(?:s|ed|ing)?": "repair", "badness": "objective",
    "facing": "reference normal", "agreement": "normal deviation", "burdens?": "predicted number of charts",
    "forecasts?": "distortion estimate", "unevenness": "area distortion", "cells?": "aggregates",
    "rooms?": "local feature size", "embeds?": "noncrossing refinement", "turned": "inconsistently oriented",
    "culprits?": "offending faces", "walls?": "feature edges", "wedges?": "sharp feature corner",
    "uncut": "recover the original triangles",
    r"(?:neighbour|colour|labell|factoris|optimis|normalis|minimis)\w*|centres?|grey": "the American spelling",
}

# (word, files, what the line must hold, reason)
WORD_EXCEPTIONS = [
    ("cells?", "formats/*", "", "VTK's word for elements, and tables of SVG"),
    ("cells?", "tests/*_test.py", "", "VTK's word for elements"),
    ("cells?", "tools/mconvert.1", "", "VTK's word for elements"),
    ("cells?", "tests/unit/formats/*", "", "VTK's word for elements"),
    ("cells?", "lib/core/*", "", "squares and cubes of a search grid"),
    ("cells?", "*shape*", "", "cubes of the grid that marching goes through"),
    ("tips?", "lib/param/ears.*", "", "real ones: of ears"),
    ("tips?", "tests/unit/check/*", "", "real ones: of needles"),
    ("tips?", "tests/unit/multiscale/*", "", "real ones: of branches"),
    ("rooms?", "*", r"rooms? (?:for|in|to)\b|make_room", "space in a file, an array, or between lines"),
    ("walls?", "CMakeLists.txt", "-Wall", "the compiler's option"),
    ("walls?", "scripts/benches/*", "", "time by the clock on the wall"),
    ("walls?", "lib/cap/*", "", "real ones: of vessels"),
    ("walls?", "tools/mcap.*", "", "real ones: of vessels"),
    ("walls?", "formats/*", "", "real ones: names of patches"),
    ("walls?", "tests/*", "", "real ones: names of patches"),
    ("wedges?", "*", "kappa_off_wedges", "a key of mcheck's report and contract, which is public"),
    ("turned", "*", "turned_edges", "a key of mcheck's report, which is public"),
    ("culprits?", "*", r"--culprits|Fl -culprits|o\.culprits", "a public option of mclean and mcheck"),
    ("cells?", "scripts/benches/*", "", "entries of a printed table"),
    ("cells?", "README.md", "cell_data", "meshio's and PyVista's word for elements"),
    ("cells?", "scripts/python/*", "", "meshio's and PyVista's word for elements"),
    ("cells?", "tests/cases/*", "", "VTK's word for elements"),
    ("cells?", "tools/report/*", "", "entries of a table of pictures"),
    ("cells?", "tests/unit/core/chart_test.cc", "", "squares of a grid"),
    ("culprits?", "tests/cases/check-finds-faults/*", "", "written by a public option"),
    ("beside", "*", r"--beside|Fl -beside", "a public option of mdraw"),
]
