#include "frames/video_decoder.h"

#include "edgeslam/input_error.h"
#include "plugins/plugin.h"

namespace edgeslam {

std::unique_ptr<VideoDecoder> openVideo(const std::string& path) {
  const OpenedPlugin plugin = openPlugin("libedgeslam_video.so", open_video_name);
  if (!plugin.function) {
    throw InputError(path +
                     ": videos are read by the package edgeslam-tools, which is to be installed: sudo apt install " +
                     "./edgeslam-tools_*.deb (" + plugin.problem + ")");
  }
  std::unique_ptr<VideoDecoder> decoder(reinterpret_cast<OpenVideoFunction*>(plugin.function)(path.c_str()));
  if (decoder) return decoder;
  throw InputError(path + ": cannot be opened as a video; it is damaged, cut off, or of an unknown format");
}

}  // namespace edgeslam
