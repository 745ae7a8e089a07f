#include "frames/mask_file.h"

#include <vector>

#include "edgeslam/input_error.h"
#include "frames/image_file.h"
#include "image_formats/png.h"

namespace edgeslam {

std::shared_ptr<const CameraMask> readMask(const std::string& path) {
  const DecodedImage image = readGreyImage(path);
  if (!image.problem.empty()) {
    throw InputError(image.problem + "; expected an image of the camera's size, black where it is not looked at");
  }
  auto mask = makeCameraMask(image.grey);
  if (!leavesSomething(*mask)) {
    throw InputError(path + ": all of it is black; expected black only where the camera's images are not looked at");
  }
  return mask;
}

std::string maskSizeProblem(const CameraMask& mask, const Camera& camera) {
  return sizeProblem(mask.masked.size(), {camera.width, camera.height}, "expected the camera's size,");
}

std::string encodeMask(const CameraMask& mask) {
  const std::vector<unsigned char> png = encodePng(~mask.masked);
  return {png.begin(), png.end()};
}

}  // namespace edgeslam
