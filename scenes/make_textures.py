#!/usr/bin/env python3
"""Writes the small pictures of scenes/textures/: a checkerboard, bricks with their heights, leaves with holes between them, a globe.

They are made here, by this program alone, from arithmetic and a fixed seed; run it to make them anew.
"""
import math
import os
import random
import struct
import zlib

HERE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "textures")


def write_png(name, width, height, pixel):
    """pixel(x, y) -> tuple of 1, 3 or 4 values in [0, 255]."""
    channels = len(pixel(0, 0))
    colour_type = {1: 0, 3: 2, 4: 6}[channels]
    rows = b"".join(b"\0" + bytes(int(max(0, min(255, v))) for x in range(width) for v in pixel(x, y)) for y in range(height))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    with open(os.path.join(HERE, name), "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, colour_type, 0, 0, 0)))
        file.write(chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def checker(x, y):
    return (235, 232, 220) if (x // 8 + y // 8) % 2 == 0 else (40, 44, 60)


BRICK_W, BRICK_H, JOINT = 32, 16, 2
random.seed(8)
TONES = [[random.uniform(0.8, 1.1) for _ in range(8)] for _ in range(8)]


def brick_at(x, y):
    """Distance from the joint in pixels, and the brick's tone; the picture repeats every 64 x 64."""
    row = y // BRICK_H % 4
    shifted = (x + (BRICK_W // 2 if row % 2 else 0)) % 64
    dx = min(shifted % BRICK_W, BRICK_W - 1 - shifted % BRICK_W)
    dy = min(y % BRICK_H, BRICK_H - 1 - y % BRICK_H)
    return min(dx, dy) - JOINT / 2, TONES[row][shifted // BRICK_W]


def brick(x, y):
    depth, tone = brick_at(x, y)
    if depth < 0:
        return (150, 145, 135)
    grain = 1 + 0.08 * math.sin(x * 1.7 + 3 * math.sin(y * 0.9)) * math.sin(y * 2.3)
    return tuple(v * tone * grain for v in (178, 84, 62))


def brick_height(x, y):
    depth, tone = brick_at(x, y)
    return (0 if depth < 0 else min(1, depth / 3) * 200 + 20 * math.sin(x * 1.7 + 3 * math.sin(y * 0.9)) * math.sin(y * 2.3) + 30,)


LEAVES = [(random.uniform(0, 128), random.uniform(0, 128), random.uniform(0, math.tau), random.uniform(9, 16)) for _ in range(46)]


def leaf(x, y):
    best, shade = -1.0, 0.0
    for number, (cx, cy, turn, length) in enumerate(LEAVES):
        dx, dy = (x - cx + 64) % 128 - 64, (y - cy + 64) % 128 - 64
        u, v = dx * math.cos(turn) + dy * math.sin(turn), -dx * math.sin(turn) + dy * math.cos(turn)
        inside = 1 - abs(u / length) ** 1.6 - abs(v / (0.38 * length)) ** 1.3
        if inside > best:
            best, shade = inside, 0.75 + 0.25 * math.sin(number) - (0.25 if abs(v) < 0.8 else 0)
    alpha = 255 if best > 0.08 else 0 if best < -0.02 else (best + 0.02) * 2550
    return (70 * shade, 130 * shade, 45 * shade, alpha)


def globe(x, y):
    longitude, latitude = math.tau * x / 128, math.pi * (y / 64 - 0.5)
    land = math.sin(3 * longitude + 2 * math.sin(2 * latitude)) * math.cos(2 * latitude) + 0.6 * math.sin(5 * longitude + 4 * latitude)
    if x % 16 == 0 or y % 8 == 0:
        return (245, 245, 245)
    return (196, 160, 92) if land > 0.35 else (58, 96, 148)


def main():
    os.makedirs(HERE, exist_ok=True)
    write_png("checker.png", 16, 16, checker)
    write_png("brick.png", 64, 64, brick)
    write_png("brick_height.png", 64, 64, brick_height)
    write_png("leaves.png", 128, 128, leaf)
    write_png("globe.png", 128, 64, globe)


if __name__ == "__main__":
    main()
