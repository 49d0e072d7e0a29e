# The benchmarks of docs/performance.md: `benchmarks/table.py` runs them and prints the table.

find_package(benchmark REQUIRED)
file(GLOB vantage_benchmark_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/benchmarks/*.cpp)
add_executable(vantage_benchmarks ${vantage_benchmark_sources})
target_link_libraries(vantage_benchmarks PRIVATE vantage_core vantage_build_settings benchmark::benchmark)
