// The saved map: all of a map in one run of bytes, versioned and with a checksum, the same on every machine.
//
// Numbers are little endian: u32 u64 i32 i64, f64 (IEEE 754), flag (one byte, 0 or 1). A text and an image are a u64
// length and so many bytes; a list is a u64 count and so many records. The layout of version 4:
//
//   "EDGESLAM MAP\r\n\x1a\n"   16 bytes
//   version                    u32
//   length of the payload      u64
//   payload                    the sections CAMR, KEYF, PNTS, LINE, SCAL: four letters, u64 length, content
//   checksum                   u32, CRC-32 (zlib's crc32) of all bytes before it
//
//   CAMR   model u32 (0 pinhole with radial-tangential distortion, 1 Kannala-Brandt), width i32, height i32 [px],
//          fx fy cx cy f64 [px], distortion 5 f64, readout f64 [s] (not in versions 1 and 2: 0)
//   KEYF   list of keyframes, ids ascending: id i32, world i32 (not in version 1: all are 0), frame index i64, time i64
//          [ns], world_T_camera (rotation w x y z, translation x y z, f64), twist (translation [map units/s], rotation
//          [rad/s], 6 f64; not in versions 1 and 2: 0), reason text (ASCII), list of observations (points ascending),
//          list of straight edges (not in versions 1 and 2), has images flag; where 1: frame index i64 and time i64
//          [ns] of the images, pyramid levels i32, image (grey 8-bit PNG)
//          * observation: point i64, pixel x y f64, normal x y f64, sigma across and along the edge f64 [px], bearing
//          x y z f64, corner flag, chain i32, order i32, straight edge i32 (index; not in versions 1 and 2: -1)
//          * straight edge: line i64 (-1: none), of each of its two ends pixel x y f64 [px] and bearing x y z f64,
//          sigma f64 [rad]
//   PNTS   list of points, ids ascending: id i64, host i32, bearing in the host x y z f64, inverse depth and its sigma
//          f64, corner flag, chain's keyframe i32, chain i32, order i32, seen in (list of i32, ascending)
//   LINE   (not in versions 1 and 2) the next line's id i64, list of lines, ids ascending: id i64, host i32, a point
//   and
//          the direction in the host 6 f64, placed flag, begin and end f64 [map units], seen in (list of i32,
//          ascending)
//   SCAL   (not in versions 1 to 3) scales of worlds, where they are known: list of those of an inertial unit,
//          worlds ascending: world i32, metres a map unit f64, its standard deviation as a share of it f64, gravity x y
//          z in the world 3 f64 [m/s^2]; list of those of wheels, worlds ascending: world i32, metres a map unit and
//          its standard deviation f64
//
// What stands before the payload, and the checksum, stay as they are in every version.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "geometry/camera.h"
#include "map/map.h"

namespace edgeslam {

constexpr std::uint32_t map_format_version = 4;

struct SavedMap {
  Camera camera;  // whose pixels the observations are
  Map map;
  std::uint32_t version = map_format_version;  // of the file that it was read from
};

// Encodes a map, the same one to the same bytes. Of a keyframe's images only level 0 is written, without loss; images
// must be CV_8U. What mapProblem (map/map_check.h) finds wrong is written all the same, and refused by decodeMap.
std::string encodeMap(const SavedMap& saved);

// The map of which `bytes` are the encoding, every number to the last bit and the pyramids built anew. `name` (of the
// file) begins messages. Throws InputError where the bytes are no map, cut off, changed, of a newer version, or, though
// the checksum is right, not a map that the program could work with.
SavedMap decodeMap(std::string_view bytes, const std::string& name);

}  // namespace edgeslam
