"""Writes the frames of frames.py as a bag of ROS 1: write_ros1.py FRAMES OUT none|bz2|lz4|realsense.

`realsense` has the topics of a recording by a RealSense camera: no poses, its own names, depths in units of 0.25 mm.
"""

import json
import math
import pathlib
import sys

import genpy
import rosbag
from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import CameraInfo, Image
from std_msgs.msg import Float32
from tf2_msgs.msg import TFMessage

# The camera on the hand, and the axes of its image in those of its housing: x, y, z, qx, qy, qz, qw.
HAND_FROM_CAMERA = [0.02, -0.03, 0.05, 0, math.sqrt(0.5), 0, math.sqrt(0.5)]
CAMERA_FROM_OPTICAL = [0, 0.01, 0, -0.5, 0.5, -0.5, 0.5]


def turn(q, v):
    x, y, z, w = q
    t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])]
    return [v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2],
            v[2] + w * t[2] + x * t[1] - y * t[0]]


def product(a, b):
    x, y, z, w = a[3:]
    p, q, r, s = b[3:]
    moved = turn(a[3:], b[:3])
    return [a[0] + moved[0], a[1] + moved[1], a[2] + moved[2], w * p + x * s + y * r - z * q, w * q - x * r + y * s + z * p,
            w * r + x * q - y * p + z * s, w * s - x * p - y * q - z * r]


def inverse(a):
    q = [-a[3], -a[4], -a[5], a[6]]
    return [-v for v in turn(q, a[:3])] + q


def transform(stamp, parent, child, pose):
    made = TransformStamped()
    made.header.stamp, made.header.frame_id, made.child_frame_id = stamp, parent, child
    made.transform.translation.x, made.transform.translation.y, made.transform.translation.z = pose[:3]
    rotation = made.transform.rotation
    rotation.x, rotation.y, rotation.z, rotation.w = pose[3:]
    return made


def camera_info(scene, stamp, frame_id):
    info, k = CameraInfo(), scene["k"]
    info.header.stamp, info.header.frame_id = stamp, frame_id
    info.height, info.width, info.distortion_model, info.D, info.K = scene["height"], scene["width"], "plumb_bob", [0.0] * 5, k
    info.R = [1.0, 0, 0, 0, 1, 0, 0, 0, 1]
    info.P = [k[0], 0, k[2], 0, 0, k[4], k[5], 0, 0, 0, 1, 0]
    return info


def depth_image(scene, stamp, frame_id, encoding, data):
    image = Image()
    image.header.stamp, image.header.frame_id = stamp, frame_id
    image.height, image.width, image.encoding = scene["height"], scene["width"], encoding
    image.step, image.data = 2 * scene["width"], data
    return image


def write_robot(bag, folder, scene):
    first = genpy.Time.from_sec(0) + genpy.Duration(nsecs=int(scene["frames"][0]["stamp_ns"]))
    bag.write("/tf_static", TFMessage([transform(first, "/hand", "/camera_link", HAND_FROM_CAMERA), transform(
        first, "/camera_link", "/camera_optical_frame", CAMERA_FROM_OPTICAL)]), first)
    optical = product(HAND_FROM_CAMERA, CAMERA_FROM_OPTICAL)
    for frame in scene["frames"]:
        stamp = genpy.Time(int(frame["stamp_ns"]) // 10**9, int(frame["stamp_ns"]) % 10**9)
        hand = product(frame["pose"], inverse(optical))
        bag.write("/tf", TFMessage([transform(stamp, "base", "hand", hand)]), stamp)
        bag.write("/camera/depth/camera_info", camera_info(scene, stamp, "camera_optical_frame"), stamp)
        data = (folder / frame["depth"]).read_bytes()
        bag.write("/camera/depth/image_raw", depth_image(scene, stamp, "camera_optical_frame", "16UC1", data), stamp)


def write_realsense(bag, folder, scene):
    sensor = "/device_0/sensor_0/"
    for number, frame in enumerate(scene["frames"]):
        stamp = genpy.Time(number // 10, 100_000_000 * (number % 10))
        if number == 0:
            bag.write(sensor + "option/Depth_Units/value", Float32(0.00025), stamp)
            bag.write(sensor + "Depth_0/info/camera_info", camera_info(scene, stamp, "0"), stamp)
        data = (folder / frame["depth"]).read_bytes()
        bag.write(sensor + "Depth_0/image/data", depth_image(scene, stamp, "0", "mono16", data), stamp)


def main():
    folder, out, kind = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3]
    scene = json.loads((folder / "frames.json").read_text(encoding="utf-8"))
    compression = "none" if kind == "realsense" else kind
    chunk = 3000 if len(scene["frames"]) <= 6 else 768 * 1024
    with rosbag.Bag(out, "w", compression=compression, chunk_threshold=chunk) as bag:
        (write_realsense if kind == "realsense" else write_robot)(bag, folder, scene)


if __name__ == "__main__":
    main()
