# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Batches of sources that can be read as one file, so that the headers they share are read once.

Most of the time of a compiler that only checks goes into headers. Sources share a batch where
nothing that one keeps to itself (its anonymous namespaces, its macros and using-declarations) has a
name that another one uses; constants get a name of their own. All that is read off the text, line
by line, and may be wrong: whoever finds a fault in a batch has to look at its sources one by one.
"""

import collections
import re

LARGEST_BATCH = 16  # sources; more would leave cores without work at the end
OPEN_BATCHES = 3  # neighbours share the most headers, so only so many batches are filled at once

WORD = re.compile(r"\w+")
COMMENT = re.compile(r"//.*")
DECLARED = re.compile(r"(\w+)\s*[(={;\[]")
CONSTANT = re.compile(r"\bk[A-Z]\w*(?=\s*[={\[])")
TYPE = re.compile(r"(?:struct|class|enum class|enum|union)\s+(\w+)")
ALIAS = re.compile(r"(?:using|namespace)\s+(\w+)\s*=|#\s*define\s+(\w+)")
USING = re.compile(r"using\s+(?:\w+::)+(\w+);")
INCLUDE = re.compile(r"^\s*#\s*include\s*\S+", re.MULTILINE)
NO_NAMES = {"static_assert", "return", "namespace", "template", "requires", "else"}

# What a source keeps to itself: functions, constants, other names (types, variables), and aliases
# {name: its line}, which others may repeat. words: all that it uses.
Source = collections.namedtuple("Source", "functions constants names aliases words")


def read_source(text, headers=""):
    """What matters of a source; headers: the text of those of ours that it includes."""
    functions, names, aliases = set(), set(), {}
    inside = False  # an anonymous namespace
    for line in text.splitlines():
        alias, using = ALIAS.match(line), USING.match(line)
        if line.startswith("namespace {"):
            inside = True
        elif line.rstrip() == "}  // namespace":
            inside = False
        elif alias:
            aliases[alias.group(1) or alias.group(2)] = line
        elif using:
            names.add(using.group(1))  # whether it is used shows only in its own source
        elif inside and line and line[0] not in " }#/)":
            kind, declared = TYPE.match(line), DECLARED.search(line)
            if kind:
                names.add(kind.group(1))
            elif declared and declared.group(1) not in NO_NAMES:
                (functions if declared.group(0).endswith("(") else names).add(declared.group(1))
            names.update(CONSTANT.findall(line))
    # A constant hides those of a header that is read later; one that no header has can be renamed.
    in_headers = set(CONSTANT.findall(headers))
    constants = {name for name in names if re.match("k[A-Z]", name)} - set(WORD.findall(headers))
    words = set(WORD.findall(COMMENT.sub("", text))) | in_headers
    return Source(functions, constants, names - constants, aliases, words)


def clash(a, b):
    """Whether a name of one source meets another meaning in the other."""
    def hidden(own, other):
        return own.names & (other.words - other.constants) or any(
            name in other.words and other.aliases.get(name) != line
            for name, line in own.aliases.items())
    return bool(a.functions & b.functions or hidden(a, b) or hidden(b, a))


def includes_twice(text):
    """Whether a text includes the same file twice: in a batch nobody could tell."""
    includes = INCLUDE.findall(text)
    return len(includes) != len(set(includes))


def batches(texts, headers_of):
    """Puts {path: text} into lists of paths; headers_of(path) is the text of our headers there."""
    result, alone = [], []
    sources = {path: read_source(text, headers_of(path)) for path, text in texts.items()}
    for path in sorted(texts):
        if includes_twice(texts[path]):
            alone.append([path])
            continue
        for batch in result[-OPEN_BATCHES:]:
            if len(batch) < LARGEST_BATCH and not any(clash(sources[path], sources[other])
                                                      for other in batch):
                batch.append(path)
                break
        else:
            result.append([path])
    return result + alone


def batch_text(batch, texts, headers_of):
    """One source that holds all of a batch; each keeps its own lines."""
    parts = []
    for number, path in enumerate(batch):
        text = texts[path]
        constants = sorted(read_source(text, headers_of(path)).constants)
        includes = list(INCLUDE.finditer(text))
        end = text.index("\n", includes[-1].end()) + 1 if includes else 0
        renamed = "".join(f"#define {name} {name}{'_u' if '_' in name else 'U'}{number}\n"
                          for name in constants)
        forgotten = "".join(f"#undef {name}\n" for name in constants)
        parts.append(f'#line 1 "{path}"\n{text[:end]}{renamed}'
                     f'#line {text.count(chr(10), 0, end) + 1} "{path}"\n{text[end:]}\n{forgotten}')
    return "".join(parts)
