# libFuzzer programs for the readers of file formats (docs/fuzzing.md), with sanitizers.

if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  message(FATAL_ERROR "VANTAGE_FUZZ needs clang, which has libFuzzer: cmake --preset fuzz")
endif()
foreach(package fmt nlohmann_json yaml-cpp PNG ZLIB liblzf fcl urdfdom SQLite3 BZip2)
  find_package(${package} REQUIRED)
endforeach()

# vantage_fuzzed(NAME SOURCE...): a library with instrumented code.
function(vantage_fuzzed name)
  list(TRANSFORM ARGN PREPEND ${PROJECT_SOURCE_DIR}/src/vantage/ OUTPUT_VARIABLE sources)
  list(TRANSFORM sources APPEND .cpp)
  add_library(${name} STATIC ${sources} ${PROJECT_SOURCE_DIR}/fuzz/${name}.cpp)
  target_compile_features(${name} PUBLIC cxx_std_20)
  target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/fuzz)
  target_compile_definitions(${name} PRIVATE VANTAGE_EXAMPLES="${PROJECT_SOURCE_DIR}/examples")
  target_compile_options(${name} PUBLIC -O1 -g1 -ffp-contract=off -fsanitize=fuzzer-no-link,address,undefined
    -fno-sanitize-recover=all)
  target_link_libraries(${name} PUBLIC Eigen3::Eigen TBB::tbb fmt::fmt nlohmann_json::nlohmann_json yaml-cpp PNG::PNG
    ZLIB::ZLIB liblzf::liblzf urdfdom::urdfdom_model SQLite::SQLite3 BZip2::BZip2 zstd lz4)
endfunction()

# The readers' sources and what they need alone, so that trying a new reader takes seconds.
set(reader_files files/atomic_file files/text_reader formats/ply formats/polygon formats/mesh_file formats/mesh_parsers formats/stl files/yaml_text files/json_text
  formats/pcd formats/point_cloud_file formats/pose_file formats/camera_file formats/png16 formats/depth_image formats/exr formats/conf_file)
vantage_fuzzed(file_readers core/geometry core/random
  map/block_pixels map/grid map/integrate map/integrate_exactly map/integrator map/lattice_projection map/scan_limits
  map/voxel_map map/voxel_ray sensor/range_camera sensor/range_image sensor/sight_line sensor/scan_cloud
  map/scan arm/arm_description arm/urdf_check ${reader_files} formats/nrrd formats/map_file files/natural_order runs/stored_run_files
  doctor/pose_files experiments/run_outcome session/sealed_file session/session_scan session/skipped_views)
set(bag_files files/compression files/input_file files/natural_order recordings/bag recordings/bag_choice
  recordings/bag_frames recordings/bag_index recordings/bag_poses recordings/compressed_depth recordings/mcap_bag
  recordings/message_reader recordings/open_bag recordings/pose_track recordings/recording_info recordings/ros1_bag
  recordings/ros_cloud recordings/ros_image recordings/ros_messages recordings/sqlite_bag recordings/transform_tree)
vantage_fuzzed(bag_readers core/geometry sensor/range_camera sensor/range_image ${reader_files} ${bag_files})
# A robot's file ends in the planner, which is linked as it is.
vantage_fuzzed(option_readers arm/arm arm/arm_collision arm/arm_description arm/arm_kinematics arm/urdf_check arm/joint_path
  registration/fusion sensor/scan_cloud options/error_options model/from_scans
  options/reconstruct_options model/reconstruction map/scan ${reader_files} ${bag_files} recordings/frame_scans options/options
  options/robot_file recordings/scan_folder recordings/scan_bytes options/scan_planning_options recordings/pose_source sensor/organised_normals runs/run_files
  session/session_scan server/multipart server/scan_upload server/session_request)
target_link_libraries(option_readers PUBLIC vantage_core fcl)

# vantage_fuzzer(READERS GROUP...): one program per group of readers.
add_custom_target(fuzz_readers)
function(vantage_fuzzer readers)
  foreach(group IN LISTS ARGN)
    add_executable(fuzz_${group} ${PROJECT_SOURCE_DIR}/fuzz/fuzz_reader.cpp)
    target_compile_definitions(fuzz_${group} PRIVATE VANTAGE_FUZZ_GROUP="${group}" VANTAGE_FUZZ_READERS=${readers})
    target_link_libraries(fuzz_${group} PRIVATE ${readers})
    target_link_options(fuzz_${group} PRIVATE -fsanitize=fuzzer,address,undefined)
    set_target_properties(fuzz_${group} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
    add_dependencies(fuzz_readers fuzz_${group})
  endforeach()
endfunction()
vantage_fuzzer(file_readers ply mesh pcd text image map yaml json scan urdf)
vantage_fuzzer(option_readers options robot http)
vantage_fuzzer(bag_readers bag message packed)
