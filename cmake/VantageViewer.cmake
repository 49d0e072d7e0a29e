# The browser page of viewer/, built with npm into one HTML file and linked into the program as bytes. Without npm, or
# where npm cannot fetch its packages, the program carries a page that says how to get the real one.

find_program(VANTAGE_NPM npm DOC "Builds the browser page; without it reports have pictures only")
set(vantage_viewer_page ${PROJECT_BINARY_DIR}/viewer/report.html)
set(viewer ${PROJECT_SOURCE_DIR}/viewer)
if(NOT VANTAGE_NPM)
  message(WARNING "npm was not found: reports and `vantage serve` will have no interactive page. "
    "Install the Debian packages nodejs and npm and configure again.")
endif()
# A page that could not be built is tried again after the next configure.
if(EXISTS ${vantage_viewer_page}.missing)
  file(REMOVE ${vantage_viewer_page} ${vantage_viewer_page}.missing)
endif()

file(GLOB_RECURSE vantage_viewer_sources CONFIGURE_DEPENDS ${viewer}/src/*.ts ${viewer}/src/*.css)
list(FILTER vantage_viewer_sources EXCLUDE REGEX "\\.test\\.ts$")
add_custom_command(OUTPUT ${vantage_viewer_page}
  COMMAND ${CMAKE_COMMAND} -DVIEWER=${viewer} -DPAGE=${vantage_viewer_page} -DNPM=${VANTAGE_NPM}
    -P ${PROJECT_SOURCE_DIR}/cmake/build-viewer.cmake
  DEPENDS ${vantage_viewer_sources} ${viewer}/report.html ${viewer}/fallback.html ${viewer}/vite.config.ts
    ${viewer}/tsconfig.json ${viewer}/package.json ${viewer}/package-lock.json
    ${PROJECT_SOURCE_DIR}/cmake/build-viewer.cmake
  COMMENT "Building the browser page"
  VERBATIM)
set(vantage_viewer_source ${PROJECT_BINARY_DIR}/viewer/viewer_page.cpp)
configure_file(${PROJECT_SOURCE_DIR}/cmake/viewer_page.cpp.in ${vantage_viewer_source} @ONLY)
set_source_files_properties(${vantage_viewer_source} PROPERTIES OBJECT_DEPENDS ${vantage_viewer_page})
