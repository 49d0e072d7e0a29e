"""Writes bags of ROS 1 and ROS 2 without ROS: depth images, their camera and /tf, as a robot records them.

Small writers after the public descriptions of the formats, for tests that make recordings of real scans, which are too
large to be kept. The kept fixtures beside this file were written by the official writers.
"""

import bz2
import ctypes
import ctypes.util
import sqlite3
import struct


class Message:
    """Serialises one message: CDR (ROS 2) aligns numbers and ends texts with 0, ROS 1 does neither."""

    def __init__(self, cdr):
        self.cdr, self.data = cdr, bytearray()

    def put(self, kind, *values):
        size = struct.calcsize(kind)
        for value in values:
            if self.cdr:
                self.data += b"\0" * (-len(self.data) % size)
            self.data += struct.pack("<" + kind, value)

    def text(self, text):
        raw = text.encode() + (b"\0" if self.cdr else b"")
        self.put("I", len(raw))
        self.data += raw

    def header(self, ns, frame):
        if not self.cdr:
            self.put("I", 0)
        self.put("I", ns // 10**9, ns % 10**9)
        self.text(frame)

    def done(self):
        return (b"\0\1\0\0" if self.cdr else b"") + bytes(self.data)


def messages(width, height, k, frames, cdr):
    """(topic, type, time, bytes) of frames (time in ns, pose x y z qx qy qz qw, depths as little-endian uint16)."""
    for ns, pose, depths in frames:
        tf = Message(cdr)
        tf.put("I", 1)
        tf.header(ns, "base")
        tf.text("camera_optical_frame")
        tf.put("d", *pose)
        yield "/tf", "tf2_msgs/TFMessage", ns, tf.done()
        info = Message(cdr)
        info.header(ns, "camera_optical_frame")
        info.put("I", height, width)
        info.text("plumb_bob")
        info.put("I", 5)
        info.put("d", 0, 0, 0, 0, 0, *k, 1, 0, 0, 0, 1, 0, 0, 0, 1, k[0], 0, k[2], 0, 0, k[4], k[5], 0, 0, 0, 1, 0)
        info.put("I", 0, 0, 0, 0, 0, 0)
        info.put("B", 0)
        yield "/camera/depth/camera_info", "sensor_msgs/CameraInfo", ns, info.done()
        image = Message(cdr)
        image.header(ns, "camera_optical_frame")
        image.put("I", height, width)
        image.text("16UC1")
        image.put("B", 0)
        image.put("I", 2 * width, len(depths))
        image.data += depths
        yield "/camera/depth/image_raw", "sensor_msgs/Image", ns, image.done()


def zstd(data):
    library = ctypes.CDLL(ctypes.util.find_library("zstd"))
    library.ZSTD_compressBound.restype = library.ZSTD_compress.restype = ctypes.c_size_t
    room = library.ZSTD_compressBound(ctypes.c_size_t(len(data)))
    packed = ctypes.create_string_buffer(room)
    size = library.ZSTD_compress(packed, ctypes.c_size_t(room), data, ctypes.c_size_t(len(data)), 1)
    return packed.raw[:size]


def lz4(data):
    library = ctypes.CDLL(ctypes.util.find_library("lz4"))
    library.LZ4F_compressFrameBound.restype = library.LZ4F_compressFrame.restype = ctypes.c_size_t
    room = library.LZ4F_compressFrameBound(ctypes.c_size_t(len(data)), None)
    packed = ctypes.create_string_buffer(room)
    size = library.LZ4F_compressFrame(packed, ctypes.c_size_t(room), data, ctypes.c_size_t(len(data)), None)
    return packed.raw[:size]


def write_mcap(path, stream, compression="", chunk=1 << 20):
    """A file of MCAP (https://mcap.dev/spec) with chunks and without the index, which is optional."""
    def text(value):
        return struct.pack("<I", len(value)) + value.encode()

    def record(kind, content):
        return struct.pack("<BQ", kind, len(content)) + content

    pack = {"": bytes, "zstd": zstd, "lz4": lz4}[compression]
    with open(path, "wb") as file:
        file.write(b"\x89MCAP0\r\n" + record(1, text("ros2") + text("")))
        channels, records, times = {}, bytearray(), []

        def flush():
            if records:
                packed = pack(bytes(records))
                file.write(record(6, struct.pack("<QQQI", min(times), max(times), len(records), 0) + text(compression)
                                  + struct.pack("<Q", len(packed)) + packed))
            records.clear()
            times.clear()

        for topic, kind, ns, data in stream:
            if topic not in channels:
                number = channels[topic] = len(channels) + 1
                name = kind.replace("/", "/msg/")
                records.extend(record(3, struct.pack("<H", number) + text(name) + text("ros2msg") + text("")))
                records.extend(record(4, struct.pack("<HH", number, number) + text(topic) + text("cdr") + text("")))
            records.extend(record(5, struct.pack("<HIQQ", channels[topic], 0, ns, ns) + data))
            times.append(ns)
            if len(records) >= chunk:
                flush()
        flush()
        file.write(record(15, struct.pack("<I", 0)) + record(2, struct.pack("<QQI", 0, 0, 0)) + b"\x89MCAP0\r\n")


TABLES = """
CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, serialization_format TEXT NOT NULL,
  offered_qos_profiles TEXT NOT NULL);
CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, data BLOB NOT NULL);
"""


def write_sqlite(path, stream):
    database = sqlite3.connect(path)
    database.executescript(TABLES)
    topics = {}
    for topic, kind, ns, data in stream:
        if topic not in topics:
            topics[topic] = len(topics) + 1
            database.execute("INSERT INTO topics VALUES (?, ?, ?, 'cdr', '')",
                             (topics[topic], topic, kind.replace("/", "/msg/")))
        database.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)", (topics[topic], ns, data))
    database.commit()
    database.close()


def write_ros1(path, stream, compression="none", chunk=768 * 1024):
    """A bag of ROS 1 (https://wiki.ros.org/Bags/Format/2.0)."""
    pack = {"none": bytes, "bz2": bz2.compress, "lz4": lz4}[compression]

    def record(fields, data):
        head = b"".join(struct.pack("<I", len(name) + 1 + len(value)) + name.encode() + b"=" + value
                        for name, value in fields.items())
        return struct.pack("<I", len(head)) + head + struct.pack("<I", len(data)) + data

    def connection(number, topic, kind):
        about = b"".join(struct.pack("<I", len(part)) + part for part in (
            b"topic=" + topic.encode(), b"type=" + kind.encode(), b"md5sum=*", b"message_definition="))
        return record({"op": b"\x07", "conn": struct.pack("<I", number), "topic": topic.encode()}, about)

    def bag_header(index, chunks):
        fields = {"op": b"\x03", "index_pos": struct.pack("<Q", index), "conn_count": struct.pack("<I", len(topics)),
                  "chunk_count": struct.pack("<I", len(chunks))}
        return record(fields, b" " * (4096 - len(record(fields, b""))))

    topics, records, chunks = {}, bytearray(), []
    with open(path, "wb") as file:
        file.write(b"#ROSBAG V2.0\n" + bag_header(0, chunks))

        def flush():
            if records:
                chunks.append(file.tell())
                file.write(record({"op": b"\x05", "compression": compression.encode(),
                                   "size": struct.pack("<I", len(records))}, pack(bytes(records))))
            records.clear()

        for topic, kind, ns, data in stream:
            if topic not in topics:
                topics[topic] = (len(topics), kind)
                records.extend(connection(topics[topic][0], topic, kind))
            time = struct.pack("<II", ns // 10**9, ns % 10**9)
            records.extend(record({"op": b"\x02", "conn": struct.pack("<I", topics[topic][0]), "time": time}, data))
            if len(records) >= chunk:
                flush()
        flush()
        index = file.tell()
        for topic, (number, kind) in topics.items():
            file.write(connection(number, topic, kind))
        for place in chunks:
            file.write(record({"op": b"\x06", "ver": struct.pack("<I", 1), "chunk_pos": struct.pack("<Q", place),
                               "start_time": bytes(8), "end_time": bytes(8), "count": bytes(4)}, b""))
        file.seek(13)
        file.write(bag_header(index, chunks))
