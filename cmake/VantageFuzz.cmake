# libFuzzer programs for every reader of a file format (fuzz/README.md), with sanitizers. They are built from the readers'
# sources alone, so that trying a new reader takes seconds.

if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  message(FATAL_ERROR "VANTAGE_FUZZ needs clang, which has libFuzzer: cmake --preset fuzz")
endif()
foreach(package fmt nlohmann_json yaml-cpp PNG liblzf)
  find_package(${package} REQUIRED)
endforeach()

set(sources core/geometry map/grid map/voxel_map sensor/range_camera sensor/range_image)
foreach(name atomic_file text_reader ply polygon mesh_file mesh_parsers stl pcd point_cloud_file pose_file json_text
        yaml_text camera_file png16 depth_image nrrd map_file conf_file options)
  list(APPEND sources io/${name})
endforeach()
list(TRANSFORM sources PREPEND ${PROJECT_SOURCE_DIR}/src/vantage/)
list(TRANSFORM sources APPEND .cpp)
add_library(vantage_fuzzed STATIC ${sources} ${PROJECT_SOURCE_DIR}/fuzz/readers.cpp)
target_compile_features(vantage_fuzzed PUBLIC cxx_std_20)
target_include_directories(vantage_fuzzed PUBLIC ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/fuzz)
target_compile_options(vantage_fuzzed PUBLIC -O1 -g1 -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all)
target_link_libraries(vantage_fuzzed
  PUBLIC Eigen3::Eigen TBB::tbb fmt::fmt nlohmann_json::nlohmann_json yaml-cpp PNG::PNG liblzf::liblzf)

add_custom_target(fuzz_readers)
foreach(reader mesh_ply mesh_obj mesh_stl mesh_off cloud_ply cloud_pcd cloud_xyzn depth_png map_labels map_surface
        intrinsics_text intrinsics_yaml intrinsics_json pose_text pose_json trajectory conf options)
  add_executable(fuzz_${reader} ${PROJECT_SOURCE_DIR}/fuzz/fuzz_reader.cpp)
  target_compile_definitions(fuzz_${reader} PRIVATE VANTAGE_FUZZ_READER="${reader}")
  target_link_libraries(fuzz_${reader} PRIVATE vantage_fuzzed)
  target_link_options(fuzz_${reader} PRIVATE -fsanitize=fuzzer,address,undefined)
  set_target_properties(fuzz_${reader} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
  add_dependencies(fuzz_readers fuzz_${reader})
endforeach()
