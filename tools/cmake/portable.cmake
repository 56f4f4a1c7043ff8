# Libraries for programs that run on Linux systems older or other than this one (RVELAB_PORTABLE): HDF5, zlib, toml++ and
# libstdc++ go into what is linked. libc, libm, libgcc_s stay shared, as in every such package. Included by CMakeLists.txt
# instead of finding these libraries.
set(portable_libraries ${PROJECT_SOURCE_DIR}/build/portable_libraries)
if(NOT EXISTS ${portable_libraries}/complete)
  execute_process(COMMAND ${PROJECT_SOURCE_DIR}/tools/cmake/portable_libraries ${portable_libraries}
                  RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "RVELAB_PORTABLE needs static libraries of HDF5 and zlib, see above; without it they are shared")
  endif()
endif()

add_library(portable_zlib STATIC IMPORTED)
set_target_properties(portable_zlib PROPERTIES IMPORTED_LOCATION ${portable_libraries}/lib/libz.a
                                               INTERFACE_INCLUDE_DIRECTORIES ${portable_libraries}/include)
add_library(ZLIB::ZLIB ALIAS portable_zlib)
add_library(portable_hdf5 STATIC IMPORTED)
set_target_properties(portable_hdf5 PROPERTIES IMPORTED_LOCATION ${portable_libraries}/lib/libhdf5.a
                                               INTERFACE_INCLUDE_DIRECTORIES ${portable_libraries}/include)
target_link_libraries(portable_hdf5 INTERFACE portable_zlib ${CMAKE_DL_LIBS} m)
add_library(PkgConfig::HDF5 ALIAS portable_hdf5)

# Debian's toml++ is a shared library; the same headers hold its code.
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/toml.cpp CONTENT "#define TOML_IMPLEMENTATION\n#include <toml++/toml.h>\n")
add_library(portable_toml STATIC ${PROJECT_BINARY_DIR}/toml.cpp)
target_compile_options(portable_toml PUBLIC -DTOML_HEADER_ONLY=0 -DTOML_SHARED_LIB=1 PRIVATE -w)
add_library(tomlplusplus::tomlplusplus ALIAS portable_toml)

# gmp, which CGAL needs (rvelab-voids), is found by CGAL itself.
find_library(GMP_STATIC libgmp.a)
if(GMP_STATIC)
  set(GMP_LIBRARIES ${GMP_STATIC} CACHE FILEPATH "The static library of gmp")
endif()

# The oldest version of glibc that has this processor: its symbols carry it.
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "aarch64")
  set(oldest_glibc GLIBC_2.17)
else()
  set(oldest_glibc GLIBC_2.2.5)
endif()
set(older_glibc ${PROJECT_BINARY_DIR}/older_glibc.o)
execute_process(COMMAND ${CMAKE_C_COMPILER} -O2 -fPIC -D_DEFAULT_SOURCE -DRVELAB_OLDEST_GLIBC="${oldest_glibc}" -c
                        ${PROJECT_SOURCE_DIR}/tools/cmake/older_glibc.c -o ${older_glibc} COMMAND_ERROR_IS_FATAL ANY)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS tools/cmake/older_glibc.c)
add_link_options(-static-libstdc++ $<$<LINK_LANGUAGE:CXX>:${older_glibc}> -Wl,--wrap=hypot -Wl,--wrap=arc4random)
