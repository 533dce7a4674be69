"""A stream as hs-view hears it, without camera, detector and poses: frames and results of our own making."""

import math
import os
import re
import socket
import struct
import threading
import time

from houghstream.detection_t import detection_t
from houghstream.detections_t import detections_t
from houghstream.image_t import image_t
from houghstream.images_t import images_t
from houghstream.object_pose_t import object_pose_t
from houghstream.object_poses_t import object_poses_t
from houghstream.objects_t import objects_t
from houghstream.placed_object_t import placed_object_t
from houghstream.placed_objects_t import placed_objects_t
from houghstream.stage_time_t import stage_time_t
from houghstream.status_t import status_t
from houghstream.tracked_object_t import tracked_object_t

CAMERA = "64x48,58,58,32,24"
WIDTH, HEIGHT = 64, 48
NAN = float("nan")


def frame_message(utime, turn):
    """A grey image, whose brightness names the frame: 8 * (turn % 30) + 4."""
    message = images_t()
    message.utime, message.n_images = utime, 2
    message.image_types = [images_t.LEFT, images_t.DEPTH_MM]
    for pixelformat, stride, data in (
        (image_t.PIXEL_FORMAT_BGR, 3 * WIDTH, bytes([8 * (turn % 30) + 4]) * (3 * WIDTH * HEIGHT)),
        (image_t.PIXEL_FORMAT_LE_GRAY16, 2 * WIDTH, struct.pack("<H", 900) * (WIDTH * HEIGHT)),
    ):
        image = image_t()
        image.utime, image.width, image.height = utime, WIDTH, HEIGHT
        image.row_stride, image.pixelformat, image.size, image.data = stride, pixelformat, len(data), data
        message.images.append(image)
    return message


def stages(*named):
    times = []
    for name, milliseconds in named:
        stage = stage_time_t()
        stage.stage, stage.duration_us = name, int(1000 * milliseconds)
        times.append(stage)
    return times


def detections_message(utime, channel, objects):
    message = detections_t()
    message.utime, message.source_channel = utime, channel
    for class_id, (name, score, _) in enumerate(objects, 1):
        found = detection_t()
        found.class_id, found.class_name, found.score, found.reported = class_id, name, score, True
        found.box_x, found.box_y, found.box_width, found.box_height = 10.0 * class_id, 8.0, 14.0, 20.0
        found.centre_camera = [0.1, 0.0, 0.9]
        message.detections.append(found)
    message.n_detections = len(message.detections)
    message.stages = stages(("detect.leaves", 12.5))
    message.n_stages = len(message.stages)
    return message


def poses_message(utime, channel, objects, slowest_ms):
    message = object_poses_t()
    message.utime, message.source_channel = utime, channel
    for index, (name, score, status) in enumerate(objects):
        pose = object_pose_t()
        pose.class_id, pose.class_name, pose.detection_score, pose.detection_index = index + 1, name, score, index
        valid = status == object_pose_t.VALID
        pose.status, pose.trans, pose.quat = status, [0.1, 0.0, 0.9] if valid else [NAN] * 3, [1.0, 0.0, 0.0, 0.0] if valid else [NAN] * 4
        pose.converged, pose.quality, pose.visible_fraction, pose.residual_m = 1, 0.9 if valid else 0.1, 0.75, 0.002
        message.poses.append(pose)
    message.n_poses = len(message.poses)
    message.stages = stages(("detect.leaves", 12.5), ("pose.registration", slowest_ms))
    message.n_stages = len(message.stages)
    return message


def tracked(number, name, state, place, reason):
    told = tracked_object_t()
    told.track_id, told.class_id, told.class_name, told.state, told.reason = number, number, name, state, reason
    told.probability, told.trans, told.quat = 0.97, place, [1.0, 0.0, 0.0, 0.0]
    told.covariance = [[1e-5 * (row == column) for column in range(6)] for row in range(6)]
    told.n_seen, told.seen_channel = 10, "OPENNI_FRAME"
    return told


def objects_message(utime, channel, turn):
    """A bowl that goes round in a circle, and a mug that nobody sees; two cameras look on."""
    message = objects_t()
    message.utime, message.source_channel, message.world, message.world_number = utime, channel, "WORLD", 1
    side = -0.6 if channel == "SIDE" else 0.0
    message.camera_trans, message.camera_quat = [side, -0.8, 0.6], [0.707, -0.707, 0.0, 0.0]
    place = [0.3 * math.cos(0.2 * turn), 0.3 * math.sin(0.2 * turn), 0.0]
    message.objects = [tracked(1, "bowl", tracked_object_t.VISIBLE, place, "seen by OPENNI_FRAME"),
                       tracked(2, "mug <b>", tracked_object_t.HIDDEN, [0.1, 0.2, 0.0], "occluded by a nearer surface")]  # fmt: skip
    message.n_objects = len(message.objects)
    return message


MUG_BOX = {"position": [0.1, 0.2, 0.05], "quaternion": [math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)], "size": [0.08, 0.12, 0.1]}
BOWL_HEIGHT = 0.06


def placed_message(world):
    """The boxes about the objects of that world: the bowl stands on its origin, the mug is turned by a quarter."""
    message = placed_objects_t()
    message.utime, message.source_channel, message.world, message.world_number = world.utime, world.source_channel, "WORLD", 1
    for told in world.objects:
        placed = placed_object_t()
        placed.track_id, placed.class_name = told.track_id, told.class_name
        if told.class_name == "bowl":
            placed.box_trans = [*told.trans[:2], told.trans[2] + BOWL_HEIGHT / 2]
            placed.box_quat, placed.box_size = [1.0, 0.0, 0.0, 0.0], [0.16, 0.16, BOWL_HEIGHT]
        else:
            placed.box_trans, placed.box_quat, placed.box_size = MUG_BOX["position"], MUG_BOX["quaternion"], MUG_BOX["size"]
        message.objects.append(placed)
    message.n_objects = len(message.objects)
    return message


def status_message(utime):
    message = status_t()
    message.utime, message.process, message.pid, message.rate_hz = utime, "hs-pose", 4242, 10.0
    return message


class ToldStream:
    """Sends frames and what is told of them at 10 Hz while it lasts, on the bus of LCM_DEFAULT_URL. The first object's score
    changes with each frame. hs-pose tells its status until `pose_process_ended`; every fortieth frame took it five seconds. Use with `with`."""

    def __init__(self, channel="OPENNI_FRAME"):
        address, port, ttl = re.fullmatch(r"udpm://([\d.]+):(\d+)\?ttl=(\d+)", os.environ["LCM_DEFAULT_URL"]).groups()
        self.target = (address, int(port))
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, int(ttl))
        self.channel, self.sequence, self.ending = channel, 0, threading.Event()
        self.pose_process_ended = threading.Event()
        self.thread = threading.Thread(target=self.run)

    def send(self, channel, message):
        # LCM's short message: "LC02", number, name, what is sent.
        self.socket.sendto(b"LC02" + struct.pack(">I", self.sequence) + channel.encode() + b"\0" + message.encode(), self.target)
        self.sequence += 1

    def run(self):
        turn = 0
        while not self.ending.wait(0.1):
            turn += 1
            utime = int(1e6 * time.time())
            objects = [("bowl", 0.6 + 0.01 * (turn % 30), object_pose_t.VALID), ("mug <b>", 0.3, object_pose_t.REJECTED_BY_DEPTH)]
            self.send(self.channel, frame_message(utime, turn))
            self.send("HOUGHSTREAM_DETECTIONS", detections_message(utime, self.channel, objects))
            self.send("HOUGHSTREAM_POSES", poses_message(utime, self.channel, objects, 5000.0 if turn % 40 == 15 else 7.5))
            for camera in (self.channel, "SIDE"):
                world = objects_message(utime, camera, turn)
                self.send("HOUGHSTREAM_PLACED_OBJECTS", placed_message(world))
                self.send("HOUGHSTREAM_OBJECTS", world)
            if not self.pose_process_ended.is_set():
                self.send("HOUGHSTREAM_STATUS", status_message(utime))

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.ending.set()
        self.thread.join()
        self.socket.close()
