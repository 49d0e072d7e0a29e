# libFuzzer programs for the readers of file formats (docs/fuzzing.md), with sanitizers.

if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  message(FATAL_ERROR "VANTAGE_FUZZ needs clang, which has libFuzzer: cmake --preset fuzz")
endif()
foreach(package fmt nlohmann_json yaml-cpp PNG OpenEXR TIFF ZLIB liblzf fcl urdfdom SQLite3 BZip2)
  find_package(${package} REQUIRED)
endforeach()

# The readers and all that they may call, with instrumented code; the planner is linked as it is.
set(fuzzed_sources doctor/pose_files experiments/run_outcome server/admission server/multipart server/scan_upload
  server/session_request)
list(TRANSFORM fuzzed_sources PREPEND ${PROJECT_SOURCE_DIR}/src/vantage/)
list(TRANSFORM fuzzed_sources APPEND .cpp)
foreach(folder files formats recordings registration arm model options runs session)
  file(GLOB found CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/vantage/${folder}/*.cpp)
  list(FILTER found EXCLUDE REGEX "_test\\.cpp$")
  list(APPEND fuzzed_sources ${found})
endforeach()
add_library(fuzzed_readers STATIC ${fuzzed_sources} ${PROJECT_SOURCE_DIR}/fuzz/file_readers.cpp
  ${PROJECT_SOURCE_DIR}/fuzz/bag_readers.cpp ${PROJECT_SOURCE_DIR}/fuzz/option_readers.cpp)
target_compile_features(fuzzed_readers PUBLIC cxx_std_20)
target_include_directories(fuzzed_readers PUBLIC ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/fuzz)
target_compile_definitions(fuzzed_readers PRIVATE VANTAGE_EXAMPLES="${PROJECT_SOURCE_DIR}/examples"
  VANTAGE_VERSION="${PROJECT_VERSION}")
target_compile_options(fuzzed_readers PUBLIC -O1 -g1 -ffp-contract=off -fsanitize=fuzzer-no-link,address,undefined
  -fno-sanitize-recover=all)
target_link_libraries(fuzzed_readers PUBLIC vantage_core fcl Eigen3::Eigen TBB::tbb fmt::fmt nlohmann_json::nlohmann_json yaml-cpp PNG::PNG OpenEXR::OpenEXRCore TIFF::TIFF
    ZLIB::ZLIB liblzf::liblzf urdfdom::urdfdom_model SQLite::SQLite3 BZip2::BZip2 zstd lz4)

# vantage_fuzzer(READERS GROUP...): one program per group of readers.
add_custom_target(fuzz_readers)
function(vantage_fuzzer readers)
  foreach(group IN LISTS ARGN)
    add_executable(fuzz_${group} ${PROJECT_SOURCE_DIR}/fuzz/fuzz_reader.cpp)
    target_compile_definitions(fuzz_${group} PRIVATE VANTAGE_FUZZ_GROUP="${group}" VANTAGE_FUZZ_READERS=${readers})
    target_link_libraries(fuzz_${group} PRIVATE fuzzed_readers)
    target_link_options(fuzz_${group} PRIVATE -fsanitize=fuzzer,address,undefined)
    set_target_properties(fuzz_${group} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
    add_dependencies(fuzz_readers fuzz_${group})
  endforeach()
endfunction()
vantage_fuzzer(file_readers ply mesh pcd text image map yaml json scan urdf)
vantage_fuzzer(option_readers options robot http)
vantage_fuzzer(bag_readers bag message packed)
