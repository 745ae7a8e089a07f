# libedgeslam_ros2_dds.so: Cyclone DDS, and the types that idlc makes. Without type information (-t), as ROS 2's own.
set(types_folder ${CMAKE_BINARY_DIR}/ros2_types)
set(idl ${CMAKE_CURRENT_SOURCE_DIR}/ros2/dds/ros_types.idl)
add_custom_command(OUTPUT ${types_folder}/ros_types.c ${types_folder}/ros_types.h
  COMMAND ${CMAKE_COMMAND} -E make_directory ${types_folder}
  COMMAND ${IDLC} -t -x final -o ${types_folder} ${idl} DEPENDS ${idl} VERBATIM COMMENT "ROS 2 types")
add_library(edgeslam_ros2_types STATIC ${types_folder}/ros_types.c)
target_include_directories(edgeslam_ros2_types SYSTEM PUBLIC ${types_folder} ${CYCLONEDDS_INCLUDE_DIR})

file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/ros2/dds/*.cpp)
add_library(edgeslam_ros2_dds MODULE ${sources})
target_link_libraries(edgeslam_ros2_dds PRIVATE edgeslam_ros2 edgeslam_ros2_types ${CYCLONEDDS_LIBRARY})
target_link_options(edgeslam_ros2_dds PRIVATE -Wl,--as-needed)
add_dependencies(edgeslam edgeslam_ros2_dds)  # made with the program, as it is loaded by it
set_target_properties(edgeslam_ros2_dds PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
