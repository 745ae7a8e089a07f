#include "map/map_file.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <vector>

#include "image_formats/png.h"
#include "map/little_endian.h"
#include "map/map_check.h"
#include "map/worlds.h"

namespace edgeslam {
namespace {

constexpr std::string_view magic("EDGESLAM MAP\r\n\x1a\n", 16);
constexpr std::uint32_t version_with_worlds = 2, version_with_readout = 3, version_with_lines = 3,
                        version_with_scales = 4;
constexpr std::size_t header_size = 28, checksum_size = 4;
constexpr std::string_view camera_section = "CAMR", keyframe_section = "KEYF", point_section = "PNTS",
                           line_section = "LINE", scale_section = "SCAL";

// Bytes of a record that has nothing of variable length; of a keyframe and an observation in the first version, where
// they are shortest.
constexpr std::size_t observation_size = 89, least_keyframe_size = 93, least_point_size = 73, keyframe_id_size = 4;
constexpr std::size_t straight_edge_size = 96, least_line_size = 85;
constexpr std::size_t alignment_size = 44, wheel_scale_size = 20;

// A few bytes of PNG can become a large image; all together may take so much memory [byte].
constexpr std::uint64_t largest_images = std::uint64_t{1} << 32;

// The fields of each record in the file's order, for writing and reading alike.
template <typename Stream, typename CameraFields>
void cameraFields(Stream& stream, CameraFields& camera, std::uint32_t version) {
  stream(camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy);
  for (auto& coefficient : camera.distortion) stream(coefficient);
  if (version >= version_with_readout) stream(camera.readout_s);
}

template <typename Stream, typename KeyframeFields>
void keyframeFields(Stream& stream, KeyframeFields& keyframe, std::uint32_t version) {
  auto& rotation = keyframe.world_T_camera.rotation.coeffs();  // x y z w
  auto& translation = keyframe.world_T_camera.translation;
  stream(keyframe.id);
  if (version >= version_with_worlds) stream(keyframe.world);
  stream(keyframe.frame_index, keyframe.time_ns);
  stream(rotation[3], rotation[0], rotation[1], rotation[2], translation[0], translation[1], translation[2]);
  if (version >= version_with_readout) {
    for (auto& component : keyframe.twist) stream(component);
  }
  stream(keyframe.reason);
}

template <typename Stream, typename ObservationFields>
void observationFields(Stream& stream, ObservationFields& observation, std::uint32_t version) {
  auto& measured = observation.measurement;
  stream(observation.point, measured.pixel[0], measured.pixel[1], measured.normal[0], measured.normal[1],
         measured.sigma_normal, measured.sigma_tangent);
  stream(observation.bearing[0], observation.bearing[1], observation.bearing[2]);
  stream(observation.corner, observation.chain, observation.order);
  if (version >= version_with_lines) stream(observation.straight_edge);
}

template <typename Stream, typename EdgeFields>
void straightEdgeFields(Stream& stream, EdgeFields& edge) {
  stream(edge.line);
  for (auto* end : {&edge.from, &edge.to}) {
    stream(end->pixel[0], end->pixel[1], end->bearing[0], end->bearing[1], end->bearing[2]);
  }
  stream(edge.sigma);
}

template <typename Stream, typename PointFields>
void pointFields(Stream& stream, PointFields& point) {
  stream(point.id, point.host, point.host_bearing[0], point.host_bearing[1], point.host_bearing[2]);
  stream(point.inverse_depth, point.inverse_depth_sigma, point.corner);
  stream(point.chain_keyframe, point.chain, point.order);
}

template <typename Stream, typename LineFields>
void lineFields(Stream& stream, LineFields& line) {
  auto& place = line.in_host;
  stream(line.id, line.host, place.point[0], place.point[1], place.point[2]);
  stream(place.direction[0], place.direction[1], place.direction[2]);
  stream(line.is_placed, line.begin, line.end);
}

template <typename Stream, typename World, typename AlignmentFields>
void alignmentFields(Stream& stream, World& world, AlignmentFields& alignment) {
  stream(world, alignment.metres_a_unit, alignment.scale_sigma);
  stream(alignment.gravity[0], alignment.gravity[1], alignment.gravity[2]);
}

template <typename Stream, typename World, typename ScaleFields>
void wheelScaleFields(Stream& stream, World& world, ScaleFields& scale) {
  stream(world, scale.metres_a_unit, scale.sigma);
}

std::uint32_t checksum(std::string_view bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

void writeImages(ByteWriter& writer, const FrameImages& images) {
  CV_Assert(!images.pyramid.levels.empty() && images.pyramid.levels.front().type() == CV_8U);
  const std::vector<unsigned char> png = encodePng(images.pyramid.levels.front());
  writer(images.frame_index, images.time_ns, static_cast<std::int32_t>(images.pyramid.levels.size()),
         std::string(png.begin(), png.end()));
}

void writeKeyframe(ByteWriter& writer, const Keyframe& keyframe) {
  keyframeFields(writer, keyframe, map_format_version);
  writer.u64(keyframe.observations.size());
  for (const PointObservation& observation : keyframe.observations) {
    observationFields(writer, observation, map_format_version);
  }
  writer.u64(keyframe.straight_edges.size());
  for (const SeenEdge& edge : keyframe.straight_edges) straightEdgeFields(writer, edge);
  writer(static_cast<bool>(keyframe.images));
  if (keyframe.images) {
    writeImages(writer, *keyframe.images.get());
    keyframe.images.pack();
  }
}

void writePoint(ByteWriter& writer, const MapPoint& point) {
  pointFields(writer, point);
  writer.u64(point.seen_in.size());
  for (const KeyframeId id : point.seen_in) writer(id);
}

void writeLine(ByteWriter& writer, const MapLine& line) {
  lineFields(writer, line);
  writer.u64(line.seen_in.size());
  for (const KeyframeId id : line.seen_in) writer(id);
}

template <typename Records, typename WriteRecord>
void writeList(ByteWriter& writer, std::string_view section, const Records& records, const WriteRecord& write) {
  writer.raw(section);
  const std::size_t begin = writer.beginLength();
  writer.u64(records.size());
  for (const auto& record : records) write(record);
  writer.endLength(begin);
}

void writeLines(ByteWriter& writer, const Map& map) {
  writer.raw(line_section);
  const std::size_t begin = writer.beginLength();
  writer(map.next_line);
  writer.u64(map.lines.size());
  for (const auto& [id, line] : map.lines) writeLine(writer, line);
  writer.endLength(begin);
}

// Those that are known, of worlds that have keyframes.
template <typename Scale>
std::map<int, Scale> knownOf(const Map& map, const std::map<int, Scale>& scales) {
  std::map<int, Scale> known;
  for (const Keyframe& keyframe : map.keyframes) {
    const auto scale = scales.find(keyframe.world);
    if (scale != scales.end() && scale->second.is_known) known.insert(*scale);
  }
  return known;
}

void writeScales(ByteWriter& writer, const Map& map) {
  const std::map<int, InertialAlignment> inertia = knownOf(map, map.inertia);
  const std::map<int, WheelScale> wheels = knownOf(map, map.wheels);
  writer.raw(scale_section);
  const std::size_t begin = writer.beginLength();
  writer.u64(inertia.size());
  for (const auto& [world, alignment] : inertia) alignmentFields(writer, world, alignment);
  writer.u64(wheels.size());
  for (const auto& [world, scale] : wheels) wheelScaleFields(writer, world, scale);
  writer.endLength(begin);
}

void writeCamera(ByteWriter& writer, const Camera& camera) {
  writer.raw(camera_section);
  const std::size_t begin = writer.beginLength();
  writer.u32(static_cast<std::uint32_t>(camera.model));
  cameraFields(writer, camera, map_format_version);
  writer.endLength(begin);
}

// Of a PNG of 8-bit grey values that is not interlaced, as they are written here; empty for any other (ISO
// 15948, 11.2).
cv::Size sizeInPng(std::string_view png) {
  constexpr std::string_view start("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16), kind("\x08\0\0\0\0", 5);
  if (png.size() < start.size() + 8 + kind.size() || png.substr(0, start.size()) != start) return {};
  if (png.substr(start.size() + 8, kind.size()) != kind) return {};
  std::array<std::uint32_t, 2> sides{};  // big endian
  for (std::size_t i = 0; i < 8; ++i) {
    sides[i / 4] = sides[i / 4] << 8 | static_cast<unsigned char>(png[start.size() + i]);
  }
  if (sides[0] > largest_camera_side || sides[1] > largest_camera_side) return {};
  return {static_cast<int>(sides[0]), static_cast<int>(sides[1])};
}

std::shared_ptr<const FrameImages> readImages(ByteReader& reader, cv::Size size) {
  auto images = std::make_shared<FrameImages>();
  std::int32_t levels = 0;
  reader(images->frame_index, images->time_ns, levels);
  const std::string_view png = reader.raw(reader.u64());
  if (sizeInPng(png) != size) reader.fail("the image before is no grey PNG of the camera's size");
  const cv::Mat grey = decodePng(png);
  if (grey.type() != CV_8U || grey.size() != size) reader.fail("the image before is damaged");
  images->pyramid = buildPyramid(grey, levels);
  if (static_cast<std::int64_t>(images->pyramid.levels.size()) != levels) {
    reader.fail("an image of this size has no " + std::to_string(levels) + " pyramid levels");
  }
  return images;
}

Keyframe readKeyframe(ByteReader& reader, cv::Size size, std::uint32_t version) {
  Keyframe keyframe;
  keyframeFields(reader, keyframe, version);
  std::vector<PointObservation> observations(reader.count(observation_size));
  for (PointObservation& observation : observations) observationFields(reader, observation, version);
  keyframe.observations = std::move(observations);
  if (version >= version_with_lines) {
    keyframe.straight_edges.resize(reader.count(straight_edge_size));
    for (SeenEdge& edge : keyframe.straight_edges) straightEdgeFields(reader, edge);
  }
  bool has_images = false;
  reader(has_images);
  if (has_images) keyframe.images = readImages(reader, size);
  return keyframe;
}

MapPoint readPoint(ByteReader& reader) {
  MapPoint point;
  pointFields(reader, point);
  point.seen_in.resize(reader.count(keyframe_id_size));
  for (KeyframeId& id : point.seen_in) reader(id);
  return point;
}

ByteReader openSection(ByteReader& payload, std::string_view section) {
  if (payload.raw(section.size()) != section) payload.fail("expected section " + std::string(section) + " before");
  return payload.part(payload.u64());
}

Camera readCamera(ByteReader reader, std::uint32_t version) {
  Camera camera;
  const std::uint32_t model = reader.u32();
  if (model > 1) reader.fail("camera: unknown model " + std::to_string(model));
  camera.model = static_cast<CameraModel>(model);
  cameraFields(reader, camera, version);
  const std::string problem = cameraProblem(camera);
  if (!problem.empty()) reader.fail(problem);
  reader.expectEnd();
  return camera;
}

void readKeyframes(ByteReader reader, cv::Size size, std::uint32_t version, Map& map) {
  std::uint64_t image_bytes = 0;
  for (std::size_t left = reader.count(least_keyframe_size); left > 0; --left) {
    Keyframe keyframe = readKeyframe(reader, size, version);
    if (!map.keyframes.empty() && keyframe.id <= map.keyframes.back().id) {
      reader.fail("keyframe " + std::to_string(keyframe.id) + " comes after " +
                  std::to_string(map.keyframes.back().id));
    }
    if (keyframe.images) image_bytes += static_cast<std::uint64_t>(size.area());
    if (image_bytes > largest_images) reader.fail("more images than a map can have (4 GiB)");
    map.keyframes.push_back(std::move(keyframe));
  }
  reader.expectEnd();
}

void readPoints(ByteReader reader, Map& map) {
  for (std::size_t left = reader.count(least_point_size); left > 0; --left) {
    MapPoint point = readPoint(reader);
    if (!map.points.empty() && point.id <= map.points.rbegin()->first) {
      reader.fail("point " + std::to_string(point.id) + " comes after " + std::to_string(map.points.rbegin()->first));
    }
    map.points.emplace_hint(map.points.end(), point.id, std::move(point));
  }
  reader.expectEnd();
}

void readLines(ByteReader reader, Map& map) {
  reader(map.next_line);
  for (std::size_t left = reader.count(least_line_size); left > 0; --left) {
    MapLine line;
    lineFields(reader, line);
    line.seen_in.resize(reader.count(keyframe_id_size));
    for (KeyframeId& id : line.seen_in) reader(id);
    if (!map.lines.empty() && line.id <= map.lines.rbegin()->first) {
      reader.fail("line " + std::to_string(line.id) + " comes after " + std::to_string(map.lines.rbegin()->first));
    }
    map.lines.emplace_hint(map.lines.end(), line.id, std::move(line));
  }
  reader.expectEnd();
}

template <typename Scale>
void insertScale(const ByteReader& reader, int world, const Scale& scale, std::map<int, Scale>& scales) {
  if (!scales.empty() && world <= scales.rbegin()->first) {
    reader.fail("the scale of world " + std::to_string(world) + " comes after " +
                std::to_string(scales.rbegin()->first));
  }
  scales.emplace_hint(scales.end(), world, scale);
}

// The unit's biases are those of the run to come. What told the scale is not in the file, so that it is not adjusted
// again with the whole map.
void readScales(ByteReader reader, Map& map) {
  for (std::size_t left = reader.count(alignment_size); left > 0; --left) {
    int world = 0;
    InertialAlignment alignment;
    alignmentFields(reader, world, alignment);
    alignment.is_known = true;
    alignment.force_bias_sigma = unknown_force_bias;
    alignment.adjusted_scale_sigma = 0;
    insertScale(reader, world, alignment, map.inertia);
  }
  for (std::size_t left = reader.count(wheel_scale_size); left > 0; --left) {
    int world = 0;
    WheelScale scale;
    wheelScaleFields(reader, world, scale);
    scale.is_known = true;
    insertScale(reader, world, scale, map.wheels);
  }
  reader.expectEnd();
}

std::string strayScale(const Map& map) {
  const std::vector<int> worlds = worldsOf(map);
  const auto isThere = [&](const auto& scale) { return std::binary_search(worlds.begin(), worlds.end(), scale.first); };
  const bool are_there = std::all_of(map.inertia.begin(), map.inertia.end(), isThere) &&
                         std::all_of(map.wheels.begin(), map.wheels.end(), isThere);
  return are_there ? "" : "it tells the scale of a world that has no keyframes";
}

// The payload of a file that is whole and of a version that this program reads, which `version` gets.
ByteReader openPayload(std::string_view bytes, const std::string& name, std::uint32_t& version) {
  if (bytes.substr(0, magic.size()) != magic.substr(0, bytes.size())) {
    throw InputError(name + ": is not a map saved by edgeslam");
  }
  if (bytes.size() < header_size + checksum_size) {
    throw InputError(name + ": is cut off after " + std::to_string(bytes.size()) + " bytes");
  }
  ByteReader header(bytes, magic.size(), name);
  version = header.u32();
  const std::uint64_t length = header.u64();
  const std::uint64_t found = bytes.size() - header_size - checksum_size;
  if (length != found) {
    throw InputError(name + (length > found ? ": is cut off, or damaged" : ": is damaged") + ": " +
                     std::to_string(found) + " bytes of map are there, its header tells of " + std::to_string(length));
  }
  const std::size_t checked = bytes.size() - checksum_size;
  if (ByteReader(bytes, checked, name).u32() != checksum(bytes.substr(0, checked))) {
    throw InputError(name + ": is damaged: the checksum does not fit the content");
  }
  if (version > map_format_version) {
    throw InputError(name + ": map format version " + std::to_string(version) + " is newer than " +
                     std::to_string(map_format_version) + ", which this program reads: use a newer edgeslam");
  }
  if (version < 1) throw InputError(name + ": there is no map format version 0");
  return header.part(length);
}

}  // namespace

std::string encodeMap(const SavedMap& saved) {
  ByteWriter file;
  file.raw(magic);
  file.u32(map_format_version);
  const std::size_t payload = file.beginLength();
  writeCamera(file, saved.camera);
  writeList(file, keyframe_section, saved.map.keyframes, [&](const Keyframe& k) { writeKeyframe(file, k); });
  writeList(file, point_section, saved.map.points, [&](const auto& entry) { writePoint(file, entry.second); });
  writeLines(file, saved.map);
  writeScales(file, saved.map);
  file.endLength(payload);
  file.u32(checksum(file.bytes()));
  return file.take();
}

SavedMap decodeMap(std::string_view bytes, const std::string& name) {
  SavedMap saved;
  std::uint32_t& version = saved.version;
  ByteReader payload = openPayload(bytes, name, version);
  saved.camera = readCamera(openSection(payload, camera_section), version);
  readKeyframes(openSection(payload, keyframe_section), {saved.camera.width, saved.camera.height}, version, saved.map);
  readPoints(openSection(payload, point_section), saved.map);
  if (version >= version_with_lines) readLines(openSection(payload, line_section), saved.map);
  if (version >= version_with_scales) readScales(openSection(payload, scale_section), saved.map);
  payload.expectEnd();
  std::string problem = mapProblem(saved.camera, saved.map);
  if (problem.empty()) problem = strayScale(saved.map);
  if (!problem.empty()) throw InputError(name + ": " + problem);
  return saved;
}

}  // namespace edgeslam
