#include <libcamera/camera.h>
#include <libcamera/property_ids.h>

#include "drivers/libcamera/libcamera_camera.h"
#include "drivers/libcamera/manager.h"

namespace edgeslam {
namespace {

ListedLibcamera describe(libcamera::Camera& camera) {
  ListedLibcamera listed;
  listed.name = camera.id();
  if (const auto model = camera.properties().get(libcamera::properties::Model)) listed.model = std::string(*model);
  const auto configuration = camera.generateConfiguration({libcamera::StreamRole::VideoRecording});
  if (!configuration || configuration->empty()) {
    listed.problem = "it gives no video";
    return listed;
  }
  const libcamera::StreamFormats& formats = configuration->at(0).formats();
  for (const libcamera::PixelFormat& offered : formats.pixelformats()) {
    const auto known = knownFormat(offered);
    LibcameraFormat format{known ? pixelFormatName(*known) : offered.toString(), known.has_value(), {}};
    for (const libcamera::Size& size : formats.sizes(offered)) {
      format.sizes.emplace_back(static_cast<int>(size.width), static_cast<int>(size.height));
    }
    listed.formats.push_back(std::move(format));
  }
  for (const auto& [id, info] : camera.controls()) listed.controls.push_back({id->name(), info.toString()});
  return listed;
}

}  // namespace

LibcameraListing listLibcameras() {
  LibcameraListing listing;
  listing.version = libcamera::CameraManager::version();
  const Manager manager;
  listing.problem = manager.problem();
  if (!listing.problem.empty()) return listing;
  for (const std::shared_ptr<libcamera::Camera>& camera : manager->cameras()) {
    listing.cameras.push_back(describe(*camera));
  }
  return listing;
}

}  // namespace edgeslam
