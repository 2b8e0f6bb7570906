"""What the glTF 2.0 specification demands of a binary file's structure, checked on the bytes."""

import json
import math
import struct

import numpy as np

JSON_CHUNK, BIN_CHUNK = 0x4E4F534A, 0x004E4942
COMPONENTS = {
    5120: np.int8,
    5121: np.uint8,
    5122: np.int16,
    5123: np.uint16,
    5125: np.uint32,
    5126: np.float32,
}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}


def problems(data: bytes) -> list[str]:
    """All breaches found in a GLB file; an empty list when it is sound."""
    found = []

    def demand(holds, what):
        if not holds:
            found.append(what)
        return holds

    if not demand(len(data) >= 20 and data[:4] == b"glTF", "no GLB header"):
        return found
    version, length = struct.unpack_from("<II", data, 4)
    demand(version == 2, f"version {version}")
    demand(length == len(data), f"header says {length} bytes, the file has {len(data)}")
    chunks, at = [], 12
    while at + 8 <= len(data):
        size, kind = struct.unpack_from("<II", data, at)
        demand(size % 4 == 0, f"chunk at {at} has {size} bytes: not a multiple of 4")
        demand(at + 8 + size <= len(data), f"chunk at {at} runs beyond the file")
        chunks.append((kind, data[at + 8 : at + 8 + size]))
        at += 8 + size
    if not demand(bool(chunks) and chunks[0][0] == JSON_CHUNK, "the first chunk is not JSON"):
        return found
    text = chunks[0][1]
    demand(not text.rstrip(b" ").endswith(b"\0"), "the JSON is padded with zeros, not with spaces")
    gltf = json.loads(text)
    demand(gltf.get("asset", {}).get("version") == "2.0", "asset.version is not 2.0")
    binary = chunks[1][1] if len(chunks) > 1 and chunks[1][0] == BIN_CHUNK else b""

    buffers = gltf.get("buffers", [])
    demand(len(buffers) == 1 and "uri" not in buffers[0], "a GLB has one buffer without uri")
    demand(0 <= len(binary) - buffers[0]["byteLength"] <= 3, "buffer length and binary chunk disagree")
    views = gltf.get("bufferViews", [])
    for i, view in enumerate(views):
        end = view.get("byteOffset", 0) + view["byteLength"]
        demand(view["byteLength"] > 0 and end <= buffers[view["buffer"]]["byteLength"], f"view {i} leaves the buffer")
        stride = view.get("byteStride")
        demand(stride is None or (4 <= stride <= 252 and stride % 4 == 0), f"view {i} has stride {stride}")

    def values(index):
        accessor = gltf["accessors"][index]
        kind, width = COMPONENTS[accessor["componentType"]], WIDTHS[accessor["type"]]
        view = views[accessor["bufferView"]]
        start = accessor.get("byteOffset", 0)
        size = np.dtype(kind).itemsize
        stride = view.get("byteStride", size * width)
        demand((view.get("byteOffset", 0) + start) % size == 0, f"accessor {index} is not aligned")
        needed = start + stride * (accessor["count"] - 1) + size * width
        if not demand(accessor["count"] > 0 and needed <= view["byteLength"], f"accessor {index} leaves its view"):
            return np.zeros((0, width), kind)
        first = view.get("byteOffset", 0) + start
        raw = np.ndarray((accessor["count"], width), kind, binary, first, (stride, size))
        if kind == np.float32:
            demand(bool(np.isfinite(raw).all()), f"accessor {index} has a value that is no number")
        for key, got in (("min", raw.min(axis=0)), ("max", raw.max(axis=0))):
            if key in accessor:
                said = np.array(accessor[key])
                demand(np.allclose(said, got, rtol=1e-6, atol=1e-7), f"accessor {index}: {key} {said} is {got}")
        return raw

    for m, mesh in enumerate(gltf.get("meshes", [])):
        demand(bool(mesh["primitives"]), f"mesh {m} has no primitives")
        for p, primitive in enumerate(mesh["primitives"]):
            where = f"mesh {m} primitive {p}"
            attributes = primitive["attributes"]
            if not demand("POSITION" in attributes, f"{where} has no POSITION"):
                continue
            accessor = gltf["accessors"][attributes["POSITION"]]
            demand("min" in accessor and "max" in accessor, f"{where}: POSITION without min and max")
            position = values(attributes["POSITION"])
            for name, index in attributes.items():
                attribute = values(index)
                demand(len(attribute) == len(position), f"{where}: {name} has another length than POSITION")
                if name == "NORMAL":
                    lengths = np.linalg.norm(attribute, axis=1)
                    demand(bool(np.abs(lengths - 1).max() < 5e-3), f"{where}: normals are no unit vectors")
            if "indices" in primitive:
                accessor = gltf["accessors"][primitive["indices"]]
                demand(accessor["componentType"] in (5121, 5123, 5125), f"{where}: indices are not unsigned")
                index = values(primitive["indices"])
                demand(len(index) == 0 or int(index.max()) < len(position), f"{where}: an index beyond POSITION")
                if primitive.get("mode", 4) == 4:
                    demand(len(index) % 3 == 0, f"{where}: {len(index)} indices are no triangles")
            if "material" in primitive:
                demand(primitive["material"] < len(gltf.get("materials", [])), f"{where}: no such material")
    nodes = gltf.get("nodes", [])
    for i, node in enumerate(nodes):
        demand(node.get("mesh", 0) < max(len(gltf.get("meshes", [])), 1), f"node {i}: no such mesh")
        demand(all(c < len(nodes) for c in node.get("children", [])), f"node {i}: no such child")
        rotation = node.get("rotation")
        demand(rotation is None or abs(math.hypot(*rotation) - 1) < 1e-4, f"node {i}: rotation is no unit quaternion")
    for i, scene in enumerate(gltf.get("scenes", [])):
        demand(all(n < len(nodes) for n in scene.get("nodes", [])), f"scene {i}: no such node")
    return found
