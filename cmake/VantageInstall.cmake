# `cmake --install` gives a package that find_package(vantage) finds.
include(CMakePackageConfigHelpers)
get_property(vantage_libraries GLOBAL PROPERTY VANTAGE_LIBRARIES)
