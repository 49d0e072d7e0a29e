# The benchmarks of docs/performance.md: `benchmarks/table.py` runs them and prints the table.

find_package(benchmark REQUIRED)
file(GLOB vantage_benchmark_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/benchmarks/*.cpp)
add_executable(vantage_benchmarks ${vantage_benchmark_sources})
target_link_libraries(vantage_benchmarks PRIVATE vantage_core vantage_build_settings benchmark::benchmark)

# Other programs' answers to the same questions, as more rows of the same run.
option(VANTAGE_BENCHMARKS_OTHERS "Benchmark OctoMap, OpenVDB and Embree as well" OFF)
if(VANTAGE_BENCHMARKS_OTHERS)
  file(GLOB vantage_other_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/benchmarks/others/*.cpp)
  find_package(octomap REQUIRED)
  find_package(embree 3 REQUIRED)
  find_path(openvdb_include openvdb/openvdb.h REQUIRED)
  find_library(openvdb_library openvdb REQUIRED)
  target_sources(vantage_benchmarks PRIVATE ${vantage_other_sources})
  target_include_directories(vantage_benchmarks PRIVATE ${PROJECT_SOURCE_DIR}/benchmarks)
  target_include_directories(vantage_benchmarks SYSTEM PRIVATE ${openvdb_include})
  target_link_libraries(vantage_benchmarks PRIVATE octomap octomath embree ${openvdb_library} TBB::tbb)
endif()
