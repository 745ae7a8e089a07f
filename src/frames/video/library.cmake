# libedgeslam_video.so: videos by FFmpeg.
add_library(edgeslam_video MODULE ${CMAKE_CURRENT_SOURCE_DIR}/frames/video/ffmpeg_video.cpp)
target_link_libraries(edgeslam_video PRIVATE edgeslam_settings PkgConfig::FFMPEG)
target_link_options(edgeslam_video PRIVATE -Wl,--as-needed)
set_target_properties(edgeslam_video PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
add_dependencies(edgeslam_frames edgeslam_video)  # made with what loads it
