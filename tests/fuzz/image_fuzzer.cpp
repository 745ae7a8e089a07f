// Image files of any format: a grey image whose every pixel can be read, or one message.
#include "frames/image_file.h"
#include "fuzz_input.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edgeslam;
  static const MemoryFolder folder;
  const std::string path = folder.write("frame.png", {reinterpret_cast<const char*>(data), size});
  const DecodedImage image = readGreyImage(path);
  require(image.grey.empty() != image.problem.empty(), "there is either an image or a problem");
  if (image.grey.empty()) {
    requireMessage(image.problem, path);
    return 0;
  }
  require(image.grey.type() == CV_8U && image.grey.rows > 0 && image.grey.cols > 0, "images are 8-bit grey");
  std::uint64_t sum = 0;
  for (int y = 0; y < image.grey.rows; ++y) {
    for (int x = 0; x < image.grey.cols; ++x) sum += image.grey.ptr(y)[x];
  }
  require(sum <= std::uint64_t{255} * image.grey.total(), "every pixel can be read");
  return 0;
}
