/** Packed arrays of docs/report-data.md: base64 of a zlib stream of little-endian numbers. */
import { unzlibSync } from "fflate";

/** The document does not hold what docs/report-data.md promises. The text names the field. */
export class DataError extends Error {
  override name = "DataError";
}

const arrays = {
  u8: Uint8Array,
  i8: Int8Array,
  u16: Uint16Array,
  i16: Int16Array,
  u32: Uint32Array,
  i32: Int32Array,
  f32: Float32Array,
} as const;
interface ArrayTypes {
  u8: Uint8Array;
  i8: Int8Array;
  u16: Uint16Array;
  i16: Int16Array;
  u32: Uint32Array;
  i32: Int32Array;
  f32: Float32Array;
}
export type NumberType = keyof ArrayTypes;
export type ArrayOf<T extends NumberType> = ArrayTypes[T];

/** More bytes than this in one array is a broken document, not a big one. */
const MAX_BYTES = 2 ** 30;

export function fail(field: string, problem: string): never {
  throw new DataError(`${field}: ${problem}`);
}

export function asObject(value: unknown, field: string): Record<string, unknown> {
  if (typeof value !== "object" || value === null || Array.isArray(value)) fail(field, "must be an object");
  return value as Record<string, unknown>;
}

/** Bytes of base64 text; throws DataError naming `field` where the text is no base64. */
export function fromBase64(text: string, field: string): Uint8Array {
  let binary: string;
  try {
    binary = atob(text);
  } catch {
    fail(field, "is not base64");
  }
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

function readShape(value: unknown, field: string): [number, number] {
  if (!Array.isArray(value) || value.length < 1 || value.length > 2) fail(field, "shape must have one or two numbers");
  const [rows, columns] = [value[0], value[1] ?? 1];
  for (const n of [rows, columns]) {
    if (!Number.isInteger(n) || n < 0) fail(field, `shape [${value}] must hold whole numbers from 0`);
  }
  return [rows, columns];
}

/**
 * The numbers of a packed array. `columns` is the number of columns it must have and `rows`, where given, of rows.
 */
export function unpack<T extends NumberType>(
  value: unknown,
  type: T,
  field: string,
  columns = 1,
  rows?: number,
): ArrayOf<T> {
  const packed = asObject(value, field);
  if (packed["type"] !== type) fail(field, `type is ${JSON.stringify(packed["type"])}, must be "${type}"`);
  const [n, c] = readShape(packed["shape"], field);
  if (c !== columns) fail(field, `has ${c} columns, must have ${columns}`);
  if (rows !== undefined && n !== rows) fail(field, `has ${n} rows, must have ${rows}`);
  const Type = arrays[type];
  const size = n * c * Type.BYTES_PER_ELEMENT;
  if (size > MAX_BYTES) fail(field, `${size} bytes are too many`);
  if (typeof packed["data"] !== "string") fail(field, "data must be text");
  const compressed = fromBase64(packed["data"], field);
  let bytes: Uint8Array;
  try {
    bytes = unzlibSync(compressed);
  } catch {
    fail(field, "data is not a whole zlib stream");
  }
  if (bytes.length !== size) fail(field, `holds ${bytes.length} bytes, its shape needs ${size}`);
  const aligned = bytes.byteOffset === 0 && bytes.buffer.byteLength === size ? bytes : bytes.slice();
  if (packed["delta"] !== true) return new Type(aligned.buffer as ArrayBuffer) as unknown as ArrayOf<T>;
  if (type === "f32") fail(field, "f32 cannot be stored as differences");
  return undoDelta(aligned, new Type(n * c) as unknown as ArrayOf<T>, n, c);
}

/** Byte planes of differences back to numbers. */
function undoDelta<A extends ArrayOf<NumberType>>(bytes: Uint8Array, out: A, rows: number, columns: number): A {
  const width = out.BYTES_PER_ELEMENT;
  for (let column = 0; column < columns; ++column) {
    const first = column * width * rows;
    let last = 0;
    for (let row = 0; row < rows; ++row) {
      let difference = 0;
      for (let b = 0; b < width; ++b) difference |= bytes[first + b * rows + row] << (8 * b);
      last = (last + difference) | 0; // typed arrays take it modulo 2^bits
      out[row * columns + column] = last;
    }
  }
  return out;
}
