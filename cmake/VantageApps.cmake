# The layers above the planner and the command-line program.

find_package(nanoflann REQUIRED)
vantage_library(registration registration)
target_link_libraries(vantage_registration PUBLIC vantage_core PRIVATE $<BUILD_INTERFACE:nanoflann::nanoflann>)
vantage_unity(vantage_registration)

vantage_require(arm fcl)
vantage_require(arm urdfdom)
vantage_library(arm arm)
target_link_libraries(vantage_arm PUBLIC vantage_core PRIVATE fcl urdfdom::urdfdom_model)
vantage_unity(vantage_arm)

vantage_library(model model)
target_link_libraries(vantage_model PUBLIC vantage_core vantage_registration)
vantage_unity(vantage_model)

vantage_require(formats fmt)
vantage_require(formats nlohmann_json)
vantage_require(formats yaml-cpp)
vantage_require(formats PNG)
vantage_require(formats OpenEXR)
vantage_require(formats TIFF)
vantage_require(formats liblzf)
vantage_require(formats ZLIB)
vantage_require(formats SQLite3)
vantage_require(formats BZip2)
vantage_library(formats files formats recordings)
# Debian's zstd and lz4 have no CMake files; they lie where every compiler looks.
target_link_libraries(vantage_formats PUBLIC vantage_core nlohmann_json::nlohmann_json
  PRIVATE fmt::fmt yaml-cpp PNG::PNG OpenEXR::OpenEXRCore TIFF::TIFF liblzf::liblzf ZLIB::ZLIB SQLite::SQLite3 BZip2::BZip2 zstd lz4)
vantage_unity(vantage_formats)

vantage_library(session options runs session)
target_link_libraries(vantage_session PUBLIC vantage_model vantage_formats vantage_arm PRIVATE fmt::fmt)
vantage_unity(vantage_session)

vantage_library(doctor doctor)
target_link_libraries(vantage_doctor PUBLIC vantage_model vantage_formats PRIVATE fmt::fmt)
vantage_unity(vantage_doctor)

vantage_library(report report)
target_link_libraries(vantage_report PUBLIC vantage_session PRIVATE fmt::fmt ZLIB::ZLIB)
set_source_files_properties(${PROJECT_SOURCE_DIR}/src/vantage/session/session_result.cpp
  ${PROJECT_SOURCE_DIR}/src/vantage/server/session_page.cpp
  PROPERTIES COMPILE_DEFINITIONS VANTAGE_VERSION="${PROJECT_VERSION}")
include(VantageViewer)
target_sources(vantage_report PRIVATE ${vantage_viewer_source})
vantage_unity(vantage_report)

vantage_require(simulation embree 3)
vantage_library(simulation simulation)
target_link_libraries(vantage_simulation
  PUBLIC vantage_session PRIVATE embree $<BUILD_INTERFACE:nanoflann::nanoflann> fmt::fmt)
vantage_unity(vantage_simulation)

vantage_library(experiments experiments)
target_link_libraries(vantage_experiments PUBLIC vantage_simulation vantage_report PRIVATE fmt::fmt)
vantage_unity(vantage_experiments)

# The web server. Boost's headers are not needed by those who use the installed library.
find_package(Boost 1.74 REQUIRED)
vantage_library(server server)
target_link_libraries(vantage_server PUBLIC vantage_session vantage_report
  PRIVATE fmt::fmt $<BUILD_INTERFACE:Boost::headers>)
# g++ 12 pairs the operators new and delete of Asio's coroutine frames wrongly, and warns of it.
set_source_files_properties(${PROJECT_SOURCE_DIR}/src/vantage/server/http_connections.cpp
  ${PROJECT_SOURCE_DIR}/src/vantage/server/http_workers.cpp
  PROPERTIES COMPILE_OPTIONS $<$<CXX_COMPILER_ID:GNU>:-Wno-mismatched-new-delete> SKIP_UNITY_BUILD_INCLUSION ON)
vantage_unity(vantage_server)

find_package(CLI11 REQUIRED)
file(GLOB vantage_app_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/apps/vantage/*.cpp)
list(FILTER vantage_app_sources EXCLUDE REGEX "_test\\.cpp$")
add_executable(vantage ${vantage_app_sources})
target_link_libraries(vantage PRIVATE vantage_experiments vantage_doctor vantage_server vantage_build_settings fmt::fmt CLI11::CLI11)
target_compile_definitions(vantage PRIVATE VANTAGE_VERSION="${PROJECT_VERSION}")
# `vantage --version` says from which commit it was built, where that is known.
# Every commit, and every change of branch, is written into this file: the build files are then made again.
if(EXISTS ${PROJECT_SOURCE_DIR}/.git/logs/HEAD)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/.git/logs/HEAD)
endif()
execute_process(COMMAND git -C ${PROJECT_SOURCE_DIR} rev-parse --short=12 HEAD
  OUTPUT_VARIABLE vantage_commit ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
set_source_files_properties(${PROJECT_SOURCE_DIR}/apps/vantage/main.cpp PROPERTIES
  COMPILE_DEFINITIONS VANTAGE_COMMIT="${vantage_commit}" SKIP_UNITY_BUILD_INCLUSION ON)
vantage_unity(vantage)
set_target_properties(vantage PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})

# `mpirun vantage experiment ...` spreads the runs over many processes where MPI is installed.
find_package(MPI QUIET COMPONENTS CXX)
option(VANTAGE_MPI "Let mpirun spread experiments over processes" ${MPI_CXX_FOUND})
if(VANTAGE_MPI)
  find_package(MPI REQUIRED COMPONENTS CXX)
  target_link_libraries(vantage PRIVATE MPI::MPI_CXX)
  target_compile_definitions(vantage PRIVATE VANTAGE_MPI OMPI_SKIP_MPICXX MPICH_SKIP_MPICXX)
endif()
