// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Reads points or splats from PLY files: ASCII or binary, any numeric properties.

/** The file is not a supported PLY file. */
class FileError extends Error {}

export interface FilePoints {
  count: number;
  /** World coordinates. */
  x: Float64Array;
  y: Float64Array;
  z: Float64Array;
  classes: Uint16Array | null;
  intensities: Float32Array | null;
  /** Red, green and blue, 0 to 255. */
  colors: [Uint8Array, Uint8Array, Uint8Array] | null;
  /** Null for points; splats have radii and normals. */
  radii: Float32Array | null;
  normals: [Float32Array, Float32Array, Float32Array] | null;
}

type Reader = (view: DataView, at: number, little: boolean) => number;
const kTypes: Record<string, [number, Reader]> = {
  char: [1, (v, at) => v.getInt8(at)],
  uchar: [1, (v, at) => v.getUint8(at)],
  short: [2, (v, at, little) => v.getInt16(at, little)],
  ushort: [2, (v, at, little) => v.getUint16(at, little)],
  int: [4, (v, at, little) => v.getInt32(at, little)],
  uint: [4, (v, at, little) => v.getUint32(at, little)],
  float: [4, (v, at, little) => v.getFloat32(at, little)],
  double: [8, (v, at, little) => v.getFloat64(at, little)],
};
const kOtherNames: Record<string, string> = {
  int8: 'char',
  uint8: 'uchar',
  int16: 'short',
  uint16: 'ushort',
  int32: 'int',
  uint32: 'uint',
  float32: 'float',
  float64: 'double',
};
const kMaxHeaderBytes = 1 << 16;
const kMaxPoints = 30_000_000;

interface Property {
  name: string;
  size: number;
  read: Reader;
  offset: number;
}

interface Header {
  format: string;
  count: number;
  properties: Property[];
  stride: number;
  bytes: number;
}

function typeOf(word: string) {
  const found = kTypes[kOtherNames[word] ?? word];
  if (!found) throw new FileError(`unknown property type '${word}'`);
  return found;
}

/** Requires vertices to be the first element, as usual. */
function parseHeader(bytes: Uint8Array): Header {
  const text = new TextDecoder('latin1').decode(bytes.subarray(0, kMaxHeaderBytes));
  const end = text.match(/end_header\r?\n/);
  if (!/^ply\r?\n/.test(text) || !end) throw new FileError('not a PLY file');
  const header: Header = {
    format: '',
    count: -1,
    properties: [],
    stride: 0,
    bytes: end.index! + end[0].length,
  };
  let element = '';
  for (const line of text.slice(0, end.index).split(/\r?\n/)) {
    const words = line.trim().split(/\s+/);
    if (words[0] === 'format') header.format = words[1];
    if (words[0] === 'element') {
      element = words[1];
      if (element === 'vertex') header.count = Number(words[2]);
      else if (header.count < 0) throw new FileError(`element '${element}' precedes the vertices`);
    }
    if (words[0] !== 'property' || element !== 'vertex') continue;
    if (words[1] === 'list') throw new FileError('list properties of vertices are not supported');
    const [size, read] = typeOf(words[1]);
    header.properties.push({ name: words[2].toLowerCase(), size, read, offset: header.stride });
    header.stride += size;
  }
  if (!(header.count >= 0 && Number.isInteger(header.count))) throw new FileError('no vertices');
  if (header.count > kMaxPoints)
    throw new FileError(`${header.count} points; the maximum is ${kMaxPoints}`);
  return header;
}

/** Reader of the first column with one of the names; null if there is none. */
type Column = (names: string[]) => ((row: number) => number) | null;

function binaryColumns(buffer: ArrayBuffer, header: Header): Column {
  const { bytes, count, stride, properties, format } = header;
  if (buffer.byteLength < bytes + count * stride)
    throw new FileError(`truncated: ${count} points of ${stride} bytes do not fit in the file`);
  const view = new DataView(buffer, bytes);
  const little = format === 'binary_little_endian';
  return (names) => {
    const found = properties.find((p) => names.includes(p.name));
    return found ? (row) => found.read(view, row * stride + found.offset, little) : null;
  };
}

function textColumns(buffer: ArrayBuffer, header: Header): Column {
  const width = header.properties.length;
  const words = new TextDecoder('latin1').decode(new Uint8Array(buffer, header.bytes)).split(/\s+/);
  if (words[0] === '') words.shift();
  if (words.length < header.count * width)
    throw new FileError(`truncated: expected ${header.count} points of ${width} values`);
  return (names) => {
    const at = header.properties.findIndex((p) => names.includes(p.name));
    return at < 0 ? null : (row) => Number(words[row * width + at]);
  };
}

function filled<T extends Float64Array | Float32Array | Uint16Array | Uint8Array>(
  values: T,
  column: (row: number) => number,
): T {
  for (let i = 0; i < values.length; ++i) values[i] = column(i);
  return values;
}

/** Errors: FileError. */
export function parsePly(buffer: ArrayBuffer): FilePoints {
  const header = parseHeader(new Uint8Array(buffer));
  const { count, format } = header;
  if (!['ascii', 'binary_little_endian', 'binary_big_endian'].includes(format))
    throw new FileError(`unknown format '${format}'`);
  const column = format === 'ascii' ? textColumns(buffer, header) : binaryColumns(buffer, header);
  const axes = ['x', 'y', 'z'].map((name) => column([name]));
  if (axes.some((a) => a === null)) throw new FileError('the vertices have no x, y and z');
  const [x, y, z] = axes.map((a) => filled(new Float64Array(count), a!));
  const classes = column(['class', 'label', 'classification', 'scalar_label', 'scalar_class']);
  const intensities = column(['intensity', 'reflectance', 'scalar_intensity']);
  const bytes = ['red', 'green', 'blue'].map((name) =>
    header.properties.some((p) => p.name === name && p.size === 1) ? column([name]) : null,
  );
  const radius = column(['radius']);
  const normals = ['nx', 'ny', 'nz'].map((name) => column([name]));
  const isSplats = radius !== null && normals.every((n) => n !== null);
  return {
    count,
    x,
    y,
    z,
    classes: classes && filled(new Uint16Array(count), classes),
    intensities: intensities && filled(new Float32Array(count), intensities),
    colors: bytes.every((c) => c !== null)
      ? (bytes.map((c) => filled(new Uint8Array(count), c!)) as FilePoints['colors'])
      : null,
    radii: isSplats ? filled(new Float32Array(count), radius) : null,
    normals: isSplats
      ? (normals.map((n) => filled(new Float32Array(count), n!)) as FilePoints['normals'])
      : null,
  };
}
