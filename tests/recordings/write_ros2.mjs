// Writes the frames of frames.py as a recording of ROS 2: write_ros2.mjs MODULES FRAMES OUT VARIANT.
// MODULES is the node_modules folder with the official writers. VARIANT: none, lz4, zstd (MCAP with such chunks), flat (MCAP without
// chunks and index), big_endian, or messages: OUT.json and OUT.bin, of which write_sqlite.py makes SQLite files.
import { execFileSync } from "node:child_process";
import { createRequire } from "node:module";
import fs from "node:fs";
import path from "node:path";

const [modules, folder, out, variant] = process.argv.slice(2);
const require = createRequire(path.resolve(modules, "x.js"));
const { McapWriter } = require("@mcap/core");
const { MessageWriter } = require("@foxglove/rosmsg2-serialization");
const { CdrWriter } = require("@foxglove/cdr");
const { ros2humble } = require("@foxglove/rosmsg-msgs-common");
const zstd = require("@foxglove/wasm-zstd");

const bigEndian = variant === "big_endian";
const scene = JSON.parse(fs.readFileSync(path.join(folder, "frames.json"), "utf8"));
const { width, height, k } = scene;

const definitionOf = (type) => ros2humble[type];
function definitions(type, found = new Map()) {
  if (!found.has(type)) {
    found.set(type, { ...definitionOf(type), name: type });
    for (const field of definitionOf(type).definitions) if (field.isComplex) definitions(field.type, found);
  }
  return [...found.values()];
}

/** Big-endian CDR, which the official message writer does not have. */
function writeBigEndian(type, message, writer) {
  for (const field of definitionOf(type).definitions) {
    if (field.isConstant) continue;
    const values = field.isArray ? [...message[field.name]] : [message[field.name]];
    if (field.isArray && field.arrayLength === undefined) writer.uint32(values.length);
    for (const value of values) {
      if (field.isComplex) writeBigEndian(field.type, value, writer);
      else if (field.type === "time") writer.int32(value.sec).uint32(value.nsec);
      else writer[field.type === "bool" ? "uint8" : field.type](field.type === "bool" ? Number(value) : value);
    }
  }
}

const writers = new Map();
function serialise(type, message) {
  if (bigEndian) {
    const writer = new CdrWriter({ kind: 0 });
    writeBigEndian(type, message, writer);
    return writer.data.slice();
  }
  if (!writers.has(type)) writers.set(type, new MessageWriter([definitions(type)[0], ...definitions(type).slice(1)]));
  return writers.get(type).writeMessage(message);
}

const stamp = (ns) => ({ sec: Number(ns / 1000000000n), nsec: Number(ns % 1000000000n) });
const header = (ns, frame_id) => ({ stamp: stamp(ns), frame_id });
const vector = (v) => ({ x: v[0], y: v[1], z: v[2] });
const rotation = (q) => ({ x: q[0], y: q[1], z: q[2], w: q[3] });
const transform = (ns, parent, child, pose) => ({
  header: header(ns, parent), child_frame_id: child,
  transform: { translation: vector(pose.slice(0, 3)), rotation: rotation(pose.slice(3)) } });

const product = (a, b) => {  // of poses [x y z qx qy qz qw]
  const [x, y, z, w] = a.slice(3), [p, q, r, s] = b.slice(3);
  const turned = turn(a.slice(3), b.slice(0, 3));
  return [a[0] + turned[0], a[1] + turned[1], a[2] + turned[2],
    w * p + x * s + y * r - z * q, w * q - x * r + y * s + z * p, w * r + x * q - y * p + z * s, w * s - x * p - y * q - z * r];
};
const turn = ([x, y, z, w], v) => {
  const t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])];
  return [v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2], v[2] + w * t[2] + x * t[1] - y * t[0]];
};
const inverse = (a) => {
  const q = [-a[3], -a[4], -a[5], a[6]];
  return [...turn(q, a.slice(0, 3)).map((v) => -v), ...q];
};
// The camera on the hand, and the axes of its image (x right, y down, z forward) in those of its housing.
const handFromCamera = [0.02, -0.03, 0.05, 0, Math.SQRT1_2, 0, Math.SQRT1_2];
const cameraFromOptical = [0, 0.01, 0, -0.5, 0.5, -0.5, 0.5];
const handFromOptical = product(handFromCamera, cameraFromOptical);

/** RVL as in the paper: runs of zeros and of others, differences in groups of three bits. */
function rvl(values) {
  const groups = [];
  const number = (value) => {
    do {
      groups.push((value & 7) | (value > 7 ? 8 : 0));
      value >>>= 3;
    } while (value > 0);
  };
  let before = 0;
  for (let i = 0; i < values.length;) {
    let zeros = 0, others = 0;
    while (i + zeros < values.length && values[i + zeros] === 0) ++zeros;
    i += zeros;
    while (i + others < values.length && values[i + others] !== 0) ++others;
    number(zeros);
    number(others);
    for (const end = i + others; i < end; ++i) {
      const step = values[i] - before;
      number(((step << 1) ^ (step >> 31)) >>> 0);
      before = values[i];
    }
  }
  const words = Buffer.alloc(8 + 4 * Math.ceil(groups.length / 8));
  words.writeUInt32LE(width, 0);
  words.writeUInt32LE(height, 4);
  for (let w = 0; w < groups.length; w += 8) {
    let word = 0;
    for (let g = 0; g < 8; ++g) word = word * 16 + (groups[w + g] ?? 0);
    words.writeUInt32LE(word, 8 + w / 2);
  }
  return words;
}

/** A PNG of 16 bits by Python's zlib, as the transports of ROS write it. */
function png(values) {
  const zlib = require("node:zlib");
  const rows = Buffer.alloc(height * (2 * width + 1));
  values.forEach((v, i) => rows.writeUInt16BE(v, Math.floor(i / width) * (2 * width + 1) + 1 + 2 * (i % width)));
  const part = (kind, body) => {
    const bytes = Buffer.concat([Buffer.from(kind), body]);
    const ends = Buffer.alloc(8);
    ends.writeUInt32BE(body.length, 0);
    ends.writeUInt32BE(crc32(bytes), 4);
    return Buffer.concat([ends.subarray(0, 4), bytes, ends.subarray(4)]);
  };
  const head = Buffer.alloc(13);
  head.writeUInt32BE(width, 0);
  head.writeUInt32BE(height, 4);
  head.set([16, 0, 0, 0, 0], 8);
  return Buffer.concat([Buffer.from("\x89PNG\r\n\x1a\n", "latin1"), part("IHDR", head),
    part("IDAT", zlib.deflateSync(rows)), part("IEND", Buffer.alloc(0))]);
}
function crc32(bytes) {
  let crc = ~0;
  for (const byte of bytes) {
    crc ^= byte;
    for (let i = 0; i < 8; ++i) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc >>> 0;
}
const compressedDepth = (body) => Buffer.concat([Buffer.alloc(12), body]);

function cloud(ns, values) {
  const data = Buffer.alloc(16 * values.length);
  values.forEach((v, i) => {
    const z = v === 0 || v === 65535 ? NaN : v / 1000, u = i % width, row = Math.floor(i / width);
    [((u - k[2]) / k[0]) * z, ((row - k[5]) / k[4]) * z, z].forEach((c, j) => data.writeFloatLE(c, 16 * i + 4 * j));
  });
  const field = (name, offset) => ({ name, offset, datatype: 7, count: 1 });
  return { header: header(ns, "camera_optical_frame"), height, width, is_bigendian: false, point_step: 16,
    fields: [field("x", 0), field("y", 4), field("z", 8)], row_step: 16 * width, data, is_dense: false };
}

function* messages() {
  const small = scene.frames.length <= 6;
  const first = BigInt(scene.frames[0].stamp_ns);
  const fixed = { transforms: [transform(first, "hand", "camera_link", handFromCamera),
    transform(first, "camera_link", "camera_optical_frame", cameraFromOptical)] };
  yield ["/tf_static", "tf2_msgs/TFMessage", first, fixed];
  for (let i = 0; i < scene.frames.length; ++i) {
    const ns = BigInt(scene.frames[i].stamp_ns), pose = scene.frames[i].pose, next = scene.frames[i + 1]?.pose;
    const hand = product(pose, inverse(handFromOptical));
    yield ["/tf", "tf2_msgs/TFMessage", ns, { transforms: [transform(ns, "base", "hand", hand)] }];
    const file = fs.readFileSync(path.join(folder, scene.frames[i].depth));
    const values = new Uint16Array(file.buffer, file.byteOffset, file.length / 2);
    const info = { header: header(ns, "camera_optical_frame"), height, width, distortion_model: "plumb_bob",
      d: [0, 0, 0, 0, 0], k, r: [1, 0, 0, 0, 1, 0, 0, 0, 1], binning_x: 0, binning_y: 0,
      p: [k[0], 0, k[2], 0, 0, k[4], k[5], 0, 0, 0, 1, 0],
      roi: { x_offset: 0, y_offset: 0, height: 0, width: 0, do_rectify: false } };
    yield ["/camera/depth/camera_info", "sensor_msgs/CameraInfo", ns, info];
    yield ["/camera/depth_float/camera_info", "sensor_msgs/CameraInfo", ns, info];
    yield ["/camera/rvl/camera_info", "sensor_msgs/CameraInfo", ns, info];
    const image = (encoding, step, data) =>
      ({ header: header(ns, "camera_optical_frame"), height, width, encoding, is_bigendian: bigEndian ? 1 : 0, step, data });
    yield ["/camera/depth/image_raw", "sensor_msgs/Image", ns + 5000000n,
      image("16UC1", 2 * width, bigEndian ? Buffer.from(file).swap16() : file)];
    if (!small) continue;
    const metres = Buffer.alloc(4 * values.length);
    values.forEach((v, j) => bigEndian ? metres.writeFloatBE(v / 1000, 4 * j) : metres.writeFloatLE(v / 1000, 4 * j));
    yield ["/camera/depth_float/image_raw", "sensor_msgs/Image", ns, image("32FC1", 4 * width, metres)];
    const packed = (format, data) => ({ header: header(ns, "camera_optical_frame"), format, data });
    yield ["/camera/depth/image_raw/compressedDepth", "sensor_msgs/CompressedImage", ns,
      packed("16UC1; compressedDepth png", compressedDepth(png(values)))];
    yield ["/camera/rvl/image_raw/compressedDepth", "sensor_msgs/CompressedImage", ns,
      packed("16UC1; compressedDepth rvl", compressedDepth(rvl(values)))];
    const colors = Buffer.alloc(3 * values.length);
    values.forEach((v, j) => colors.set([v & 255, v >> 8, 7], 3 * j));
    yield ["/camera/color/image_raw", "sensor_msgs/Image", ns, image("rgb8", 3 * width, colors)];
    yield ["/cloud", "sensor_msgs/PointCloud2", ns, cloud(ns, values)];
    const body = { position: vector(pose.slice(0, 3)), orientation: rotation(pose.slice(3)) };
    const inHand = { position: vector(hand.slice(0, 3)), orientation: rotation(hand.slice(3)) };
    yield ["/pose", "geometry_msgs/PoseStamped", ns, { header: header(ns, "base"), pose: body }];
    yield ["/odom", "nav_msgs/Odometry", ns, { header: header(ns, "base"), child_frame_id: "hand",
      pose: { pose: inHand, covariance: new Float64Array(36) },
      twist: { twist: { linear: vector([0, 0, 0]), angular: vector([0, 0, 0]) }, covariance: new Float64Array(36) } }];
    if (next === undefined) continue;
    // Half way between the frames, where the interpolation of the neighbours would be too.
    const half = pose.map((v, j) => (v + next[j]) / 2), length = Math.hypot(...half.slice(3));
    const middle = product([...half.slice(0, 3), ...half.slice(3).map((v) => v / length)], inverse(handFromOptical));
    yield ["/tf", "tf2_msgs/TFMessage", ns + 50000000n,
      { transforms: [transform(ns + 50000000n, "base", "hand", middle)] }];
  }
}

async function writeMcap() {
  await zstd.isLoaded;
  const file = fs.openSync(out, "w");
  let position = 0n;
  const writable = { position: () => position,
    write: async (bytes) => { fs.writeSync(file, bytes); position += BigInt(bytes.byteLength); } };
  const packers = { lz4: (data) => execFileSync("lz4", ["-1", "-c"], { input: data, maxBuffer: 1 << 30 }), zstd: (data) => zstd.compress(data, 3) };
  const pack = packers[variant];
  const whole = variant !== "flat";
  const writer = new McapWriter({ writable, useChunks: whole, useStatistics: whole, useSummaryOffsets: whole,
    repeatSchemas: whole, repeatChannels: whole, useMessageIndex: whole, useChunkIndex: whole,
    chunkSize: scene.frames.length <= 6 ? 3000 : 1 << 20,
    compressChunk: pack ? (data) => ({ compression: variant, compressedData: pack(data) }) : undefined });
  await writer.start({ profile: "ros2", library: "" });
  const channels = new Map();
  let sequence = 0;
  for (const [topic, type, ns, message] of messages()) {
    if (!channels.has(topic)) {
      const schemaId = await writer.registerSchema({ name: type.replace("/", "/msg/"), encoding: "ros2msg", data: new Uint8Array() });
      channels.set(topic, await writer.registerChannel({ schemaId, topic, messageEncoding: "cdr", metadata: new Map() }));
    }
    const data = serialise(type, message);
    await writer.addMessage({ channelId: channels.get(topic), sequence: sequence++, logTime: ns, publishTime: ns, data });
  }
  await writer.end();
  fs.closeSync(file);
}

function writeMessages() {
  const file = fs.openSync(out + ".bin", "w");
  const entries = [];
  for (const [topic, type, ns, message] of messages()) {
    const data = serialise(type, message);
    fs.writeSync(file, data);
    entries.push([topic, type.replace("/", "/msg/"), String(ns), data.length]);
  }
  fs.closeSync(file);
  fs.writeFileSync(out + ".json", JSON.stringify(entries));
}

if (variant === "messages") writeMessages();
else await writeMcap();
