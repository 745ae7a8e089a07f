#include "image_formats/png.h"

#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <new>

#include "image_formats/image_header.h"

namespace edgeslam {
namespace {

// What a chunk beside the image may be inflated to, and how many are kept: none of them is looked at.
constexpr png_alloc_size_t largest_chunk = 1 << 20;
constexpr png_uint_32 most_chunks = 16;

// libpng comes back from an error by longjmp, which passes destructors over. So each call of it is in one of the
// functions below that say so, which have no objects with a destructor; what owns memory is with their callers.
void jumpOnError(png_structp png, png_const_charp /*message*/) { png_longjmp(png, 1); }
void ignoreWarning(png_structp /*png*/, png_const_charp /*message*/) {}

struct Input {
  const char* bytes;
  std::size_t size, at;
};

void readBytes(png_structp png, png_bytep target, std::size_t size) {
  auto* input = static_cast<Input*>(png_get_io_ptr(png));
  if (input->size - input->at < size) png_error(png, "cut off");
  std::memcpy(target, input->bytes + input->at, size);
  input->at += size;
}

class Reader {
 public:
  Reader() : png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, jumpOnError, ignoreWarning)) {
    if (png_) info_ = png_create_info_struct(png_);
    if (!info_) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw std::bad_alloc();
    }
  }
  ~Reader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  Reader(Reader&&) = delete;
  Reader& operator=(Reader&&) = delete;
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  png_structp png() const { return png_; }
  png_infop info() const { return info_; }

 private:
  png_structp png_;
  png_infop info_ = nullptr;
};

struct PngHeader {
  png_uint_32 width, height;
  int bits;
};

// Without destructors. False where it is damaged.
bool readHeader(png_structp png, png_infop info, Input* input, PngHeader* header) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_read_fn(png, input, readBytes);
  png_set_chunk_malloc_max(png, largest_chunk);
  png_set_chunk_cache_max(png, most_chunks);
  png_read_info(png, info);
  int colour = 0;
  png_get_IHDR(png, info, &header->width, &header->height, &header->bits, &colour, nullptr, nullptr, nullptr);
  const bool has_colour = (colour & PNG_COLOR_MASK_COLOR) != 0;
  png_set_strip_alpha(png);
  if (header->bits == 16) png_set_swap(png);  // every processor that it runs on has the low byte first
  if (colour == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png);
  if (!has_colour && header->bits < 8) png_set_expand_gray_1_2_4_to_8(png);
  if (has_colour) png_set_rgb_to_gray(png, 1, 0.299, 0.587);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  const std::size_t bytes = header->bits == 16 ? 2 : 1;
  return png_get_rowbytes(png, info) == header->width * bytes;
}

// Without destructors.
bool readRows(png_structp png, png_bytep* rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_read_image(png, rows);
  png_read_end(png, nullptr);
  return true;
}

class Writer {
 public:
  Writer() : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, jumpOnError, ignoreWarning)) {
    if (png_) info_ = png_create_info_struct(png_);
    if (!info_) {
      png_destroy_write_struct(&png_, nullptr);
      throw std::bad_alloc();
    }
  }
  ~Writer() { png_destroy_write_struct(&png_, &info_); }
  Writer(Writer&&) = delete;
  Writer& operator=(Writer&&) = delete;
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  png_structp png() const { return png_; }
  png_infop info() const { return info_; }

 private:
  png_structp png_;
  png_infop info_ = nullptr;
};

bool append(std::vector<unsigned char>& output, const unsigned char* bytes, std::size_t size) {
  try {
    output.insert(output.end(), bytes, bytes + size);
  } catch (const std::bad_alloc&) {
    return false;
  }
  return true;
}

void writeBytes(png_structp png, png_bytep bytes, std::size_t size) {
  if (!append(*static_cast<std::vector<unsigned char>*>(png_get_io_ptr(png)), bytes, size)) png_error(png, "no memory");
}

void nothingToFlush(png_structp /*png*/) {}

struct Packing {
  bool left_neighbour;  // only: other differences are not tried
  int level, strategy;
};

Packing packingOf(PngEffort effort) {
  switch (effort) {
    case PngEffort::huffman:
      return {true, Z_BEST_SPEED, Z_HUFFMAN_ONLY};
    case PngEffort::quick:
      return {true, Z_BEST_SPEED, Z_RLE};
    case PngEffort::small:
      break;
  }
  return {false, Z_BEST_SPEED, Z_DEFAULT_STRATEGY};
}

// Without destructors. What can be missing is memory.
bool writeAll(png_structp png, png_infop info, const cv::Mat* image, Packing packing,
              std::vector<unsigned char>* output, png_bytep* rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, output, writeBytes, nothingToFlush);
  if (packing.left_neighbour) png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_compression_level(png, packing.level);
  png_set_compression_strategy(png, packing.strategy);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image->cols), static_cast<png_uint_32>(image->rows), 8,
               image->channels() == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  png_set_bgr(png);
  png_write_image(png, rows);
  png_write_end(png, info);
  return true;
}

}  // namespace

cv::Mat decodePng(std::string_view bytes) {
  const Reader reader;
  Input input{bytes.data(), bytes.size(), 0};
  PngHeader header{};
  if (!readHeader(reader.png(), reader.info(), &input, &header)) return {};
  if (std::uint64_t{header.width} * header.height > static_cast<std::uint64_t>(most_pixels)) return {};
  cv::Mat grey(static_cast<int>(header.height), static_cast<int>(header.width), header.bits == 16 ? CV_16U : CV_8U);
  std::vector<png_bytep> rows(header.height);
  for (int y = 0; y < grey.rows; ++y) rows[static_cast<std::size_t>(y)] = grey.ptr(y);
  if (!readRows(reader.png(), rows.data())) return {};
  return grey;
}

std::vector<unsigned char> encodePng(const cv::Mat& image, PngEffort effort) {
  CV_Assert(!image.empty() && (image.type() == CV_8UC1 || image.type() == CV_8UC3));
  const Writer writer;
  std::vector<unsigned char> output;
  std::vector<png_bytep> rows(static_cast<std::size_t>(image.rows));
  for (int y = 0; y < image.rows; ++y) rows[static_cast<std::size_t>(y)] = const_cast<png_bytep>(image.ptr(y));
  if (!writeAll(writer.png(), writer.info(), &image, packingOf(effort), &output, rows.data())) throw std::bad_alloc();
  return output;
}

}  // namespace edgeslam
