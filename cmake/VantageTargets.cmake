# Compiler settings that every target of the project shares, and the rule by which folders become libraries.

add_library(vantage_build_settings INTERFACE)
target_compile_features(vantage_build_settings INTERFACE cxx_std_20)
target_compile_options(vantage_build_settings INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion
  # Joined files see the names of each other, so that only shadowing within one function means anything.
  $<IF:$<BOOL:${VANTAGE_UNITY}>,-Wshadow=local,-Wshadow>
  # Fused multiply-add changes last bits; without it every processor computes the same map.
  -ffp-contract=off
  $<$<BOOL:${VANTAGE_WERROR}>:-Werror>)
if(VANTAGE_SANITIZE)
  target_compile_options(vantage_build_settings INTERFACE
    -fsanitize=${VANTAGE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(vantage_build_settings INTERFACE -fsanitize=${VANTAGE_SANITIZE})
endif()

# vantage_require(COMPONENT PACKAGE [ARGUMENTS...]): find_package for the library of that name, noted for those who use
# the installed package.
macro(vantage_require component)
  find_package(${ARGN} REQUIRED)
  string(REPLACE ";" " " arguments "${ARGN}")
  set_property(GLOBAL APPEND_STRING PROPERTY VANTAGE_REQUIRES_${component} "find_dependency(${arguments})\n")
endmacro()

# vantage_library(NAME FOLDER...): the static library vantage::NAME from src/vantage/FOLDER/*.cpp, tests excluded.
function(vantage_library name)
  set(sources)
  foreach(folder IN LISTS ARGN)
    file(GLOB found CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/vantage/${folder}/*.cpp)
    list(FILTER found EXCLUDE REGEX "_test\\.cpp$")
    list(APPEND sources ${found})
  endforeach()
  add_library(vantage_${name} STATIC ${sources})
  add_library(vantage::${name} ALIAS vantage_${name})
  set_target_properties(vantage_${name} PROPERTIES EXPORT_NAME ${name} VANTAGE_FOLDERS "${ARGN}")
  target_compile_features(vantage_${name} PUBLIC cxx_std_20)
  target_include_directories(vantage_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(vantage_${name} PRIVATE $<BUILD_INTERFACE:vantage_build_settings>)
  set_property(GLOBAL APPEND PROPERTY VANTAGE_LIBRARIES vantage_${name})
endfunction()

# vantage_unity(TARGET [FOLDER...]): compiled many files at once where VANTAGE_UNITY asks for it, but for those in the
# folders of src/vantage. Half of the time of most files goes into the same headers.
function(vantage_unity target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${VANTAGE_UNITY} UNITY_BUILD_BATCH_SIZE 12)
  # g++ takes a .cpp that is included for a header, whose classes must not have members of types that only it knows.
  target_compile_options(${target} PRIVATE $<$<BOOL:${VANTAGE_UNITY}>:-Wno-subobject-linkage>)
  foreach(folder IN LISTS ARGN)
    file(GLOB alone CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/vantage/${folder}/*.cpp)
    set_source_files_properties(${alone} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endforeach()
endfunction()

# vantage_vector_code(TARGET FOLDER/STEM): STEM_avx2.cpp and STEM_avx512.cpp are compiled for these instructions, which
# the program chooses at run time; on other processors they are left out.
function(vantage_vector_code target stem)
  set(source ${PROJECT_SOURCE_DIR}/src/vantage/${stem})
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
    set_source_files_properties(${source}_avx2.cpp PROPERTIES COMPILE_OPTIONS "-mavx2;-mfma;-mbmi;-mbmi2")
    # g++ 12 takes the deliberately undefined operands inside its own AVX-512 intrinsics for mistakes.
    set_source_files_properties(${source}_avx512.cpp PROPERTIES COMPILE_OPTIONS
      "-mavx512f;-mavx512dq;-mavx2;-mfma;-mbmi;-mbmi2;-Wno-uninitialized;-Wno-maybe-uninitialized")
    target_compile_definitions(${target} PRIVATE VANTAGE_X86_64)
  else()
    set_source_files_properties(${source}_avx2.cpp ${source}_avx512.cpp PROPERTIES HEADER_FILE_ONLY ON)
  endif()
endfunction()
