// Lists of images, TUM's rgb.txt, associations.txt and EuRoC's data.csv: frames with growing time stamps, or one
// message.
#include "edgeslam/input_error.h"
#include "frames/folder_source.h"
#include "fuzz_input.h"

namespace {

using namespace edgeslam;

template <typename Read>
void readChecked(const std::string& path, const std::string& folder, const Read& read) {
  try {
    const std::vector<StampedFile> files = read(path);
    require(!files.empty(), "a list has frames");
    for (std::size_t i = 0; i < files.size(); ++i) {
      require(i == 0 || files[i - 1].time_ns < files[i].time_ns, "time stamps increase");
      require(!files[i].path.empty(), "frames have files");
      require(files[i].path.front() == '/', "a file's path begins at the list's folder or at the root: " + folder);
    }
  } catch (const InputError& error) {
    requireMessage(error.what(), path);
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const MemoryFolder folder;
  const std::string path = folder.write("rgb.txt", {reinterpret_cast<const char*>(data), size});
  readChecked(path, folder.path(), readTumImageList);
  readChecked(path, folder.path(), readEurocImageList);
  return 0;
}
