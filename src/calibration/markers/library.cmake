# libedgeslam_markers.so: square markers by OpenCV's contributed module, or from its version 4.7 on its objdetect.
add_library(edgeslam_markers MODULE ${CMAKE_CURRENT_SOURCE_DIR}/calibration/markers/opencv_markers.cpp)
target_link_libraries(edgeslam_markers PRIVATE edgeslam_settings ${EDGESLAM_OPENCV_MARKERS})
target_link_options(edgeslam_markers PRIVATE -Wl,--as-needed)
set_target_properties(edgeslam_markers PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
add_dependencies(edgeslam_calibration edgeslam_markers)  # made with what loads it
