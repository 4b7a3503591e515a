// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes a C++ source with the files of a folder as page_files() of view/page_files.h.
// usage: node embed.mjs FOLDER SOURCE.cpp
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { extname, join } from "node:path";

const types = {
  ".html": "text/html; charset=utf-8",
  ".js": "text/javascript; charset=utf-8",
  ".css": "text/css; charset=utf-8",
  ".txt": "text/plain; charset=utf-8",
  ".svg": "image/svg+xml",
};
const kLineBytes = 4096; // per line of a string literal

const [folder, source] = process.argv.slice(2);
if (!source) throw new Error("usage: node embed.mjs FOLDER SOURCE.cpp");

// Writes other bytes than plain characters as three octal digits, so that a following digit is not
// part of the escape.
function literal(bytes) {
  const lines = [];
  for (let at = 0; at < bytes.length; at += kLineBytes) {
    let line = "";
    for (const byte of bytes.subarray(at, at + kLineBytes)) {
      const plain = byte >= 32 && byte < 127 && !'"\\?'.includes(String.fromCharCode(byte));
      line += plain ? String.fromCharCode(byte) : "\\" + byte.toString(8).padStart(3, "0");
    }
    lines.push(`"${line}"`);
  }
  return lines.join("\n") || '""';
}

const names = readdirSync(folder).sort();
const entries = names.map((name) => {
  const type = types[extname(name)];
  if (!type) throw new Error(`${name}: unknown content type`);
  return { name, type, bytes: readFileSync(join(folder, name)) };
});
const data = entries.map(({ bytes }, i) => `constexpr char kFile${i}[] =\n${literal(bytes)};\n`);
const table = entries.map(
  ({ name, type }, i) => `    {"${name}", "${type}", {kFile${i}, sizeof(kFile${i}) - 1}},\n`);
writeFileSync(source, `// Made by viewer/embed.mjs.
#include "adasplats/view/page_files.h"

namespace adasplats {
namespace {

${data.join("\n")}
constexpr PageFile kFiles[] = {
${table.join("")}};

}  // namespace

std::span<const PageFile> page_files() { return kFiles; }

}  // namespace adasplats
`);
