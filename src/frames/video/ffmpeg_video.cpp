// libedgeslam_video.so: videos by FFmpeg.
extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/log.h>
#include <libswscale/swscale.h>
}

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "frames/video_decoder.h"

namespace edgeslam {
namespace {

// Of the extensions that are taken for videos (video_source.cpp). Others, playlists among them, could name other files
// and hosts.
constexpr const char* known_formats =
    "mov,mp4,m4a,3gp,3g2,mj2,matroska,webm,avi,mpegts,mpeg,mpegvideo,m4v,h264,mjpeg,mjpeg_2000,asf";
constexpr int most_attempts = 4096;  // packets in a row that give no picture
constexpr std::int64_t most_pixels = std::int64_t{1} << 26;

struct Deleter {
  void operator()(AVFormatContext* context) const { avformat_close_input(&context); }
  void operator()(AVCodecContext* context) const { avcodec_free_context(&context); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
  void operator()(SwsContext* context) const { sws_freeContext(context); }
};

template <typename T>
using Owned = std::unique_ptr<T, Deleter>;

double ratio(AVRational r) { return r.den == 0 ? 0 : static_cast<double>(r.num) / r.den; }

class FfmpegVideo : public VideoDecoder {
 public:
  bool open(const char* path) {
    AVDictionary* options = nullptr;
    av_dict_set(&options, "protocol_whitelist", "file", 0);
    av_dict_set(&options, "format_whitelist", known_formats, 0);
    AVFormatContext* format = nullptr;
    const int opened = avformat_open_input(&format, ("file:" + std::string(path)).c_str(), nullptr, &options);
    av_dict_free(&options);
    if (opened < 0) return false;
    format_.reset(format);
    if (avformat_find_stream_info(format, nullptr) < 0) return false;
    const AVCodec* codec = nullptr;
    stream_number_ = av_find_best_stream(format, AVMEDIA_TYPE_VIDEO, -1, -1, &codec, 0);
    if (stream_number_ < 0 || codec == nullptr) return false;
    stream_ = format->streams[stream_number_];
    codec_.reset(avcodec_alloc_context3(codec));
    packet_.reset(av_packet_alloc());
    frame_.reset(av_frame_alloc());
    if (!codec_ || !packet_ || !frame_) return false;
    if (avcodec_parameters_to_context(codec_.get(), stream_->codecpar) < 0) return false;
    codec_->pkt_timebase = stream_->time_base;
    codec_->thread_count = 1;
    codec_->max_pixels = most_pixels;
    return avcodec_open2(codec_.get(), codec, nullptr) >= 0;
  }

  bool advance() override {
    for (int attempt = 0; attempt < most_attempts; ++attempt) {
      const int received = avcodec_receive_frame(codec_.get(), frame_.get());
      if (received >= 0) return true;
      if (received == AVERROR_EOF) return false;
      if (received == AVERROR(EAGAIN) && !sendPacket()) return false;
    }
    return false;
  }

  VideoPicture picture() override {
    const AVFrame& frame = *frame_;
    if (frame.width < 1 || frame.height < 1) return {};
    scaling_.reset(sws_getCachedContext(scaling_.release(), frame.width, frame.height,
                                        static_cast<AVPixelFormat>(frame.format), frame.width, frame.height,
                                        AV_PIX_FMT_BGR24, SWS_BICUBIC, nullptr, nullptr, nullptr));
    if (!scaling_) return {};
    const int stride = (3 * frame.width + 63) / 64 * 64;
    const int beyond = 64;  // that vectors may write
    pixels_.resize(static_cast<std::size_t>(stride) * static_cast<std::size_t>(frame.height) + beyond);
    unsigned char* const planes[] = {pixels_.data()};
    const int strides[] = {stride};
    if (sws_scale(scaling_.get(), frame.data, frame.linesize, 0, frame.height, planes, strides) < 0) return {};
    return {pixels_.data(), frame.width, frame.height, static_cast<std::size_t>(stride)};
  }

  double positionMilliseconds() const override {
    if (frame_->best_effort_timestamp == AV_NOPTS_VALUE) return std::numeric_limits<double>::quiet_NaN();
    const std::int64_t start = stream_->start_time == AV_NOPTS_VALUE ? 0 : stream_->start_time;
    return static_cast<double>(frame_->best_effort_timestamp - start) * ratio(stream_->time_base) * 1000;
  }

  int width() const override { return codec_->width; }
  int height() const override { return codec_->height; }

  double framesPerSecond() const override { return ratio(av_guess_frame_rate(format_.get(), stream_, nullptr)); }

  double frameCount() const override {
    if (stream_->nb_frames > 0) return static_cast<double>(stream_->nb_frames);
    if (format_->duration <= 0) return 0;
    return std::floor(static_cast<double>(format_->duration) / AV_TIME_BASE * framesPerSecond() + 0.5);
  }

 private:
  // The next packet of the video's own stream, or at the end of the file none. What the decoder refuses is left out.
  bool sendPacket() {
    while (true) {
      av_packet_unref(packet_.get());
      const int read = av_read_frame(format_.get(), packet_.get());
      if (read == AVERROR(EAGAIN)) continue;
      if (read < 0) return avcodec_send_packet(codec_.get(), nullptr) >= 0;
      if (packet_->stream_index != stream_number_) continue;
      avcodec_send_packet(codec_.get(), packet_.get());
      return true;
    }
  }

  Owned<AVFormatContext> format_;
  Owned<AVCodecContext> codec_;
  Owned<AVPacket> packet_;
  Owned<AVFrame> frame_;
  Owned<SwsContext> scaling_;
  AVStream* stream_ = nullptr;
  int stream_number_ = -1;
  std::vector<unsigned char> pixels_;
};

}  // namespace

extern "C" __attribute__((visibility("default"))) VideoDecoder* edgeslamOpenVideo(const char* path) {
  av_log_set_level(AV_LOG_QUIET);  // what is wrong is told with the frame's number
  auto video = std::make_unique<FfmpegVideo>();
  return video->open(path) ? video.release() : nullptr;
}

}  // namespace edgeslam
