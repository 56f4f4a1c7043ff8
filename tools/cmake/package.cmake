# What is installed, and the packages of it. Included by CMakeLists.txt after all targets are made.

# What a host installs: header, libraries, and how cmake and pkg-config find them. The version is that of the interface.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/rvelab)
target_include_directories(rvelab_shared INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
install(TARGETS rvelab_shared EXPORT rvelabTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library)
install(TARGETS rvelab_h5 LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library)
install(FILES include/rvelab/rvelab.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/rvelab COMPONENT library)
install(EXPORT rvelabTargets NAMESPACE rvelab:: DESTINATION ${package_folder} COMPONENT library)
configure_package_config_file(${PROJECT_SOURCE_DIR}/tools/cmake/rvelabConfig.cmake.in rvelabConfig.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(rvelabConfigVersion.cmake VERSION ${interface_version} COMPATIBILITY SameMajorVersion)
file(RELATIVE_PATH up_to_prefix /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
configure_file(${PROJECT_SOURCE_DIR}/tools/cmake/rvelab.pc.in rvelab.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/rvelabConfig.cmake ${PROJECT_BINARY_DIR}/rvelabConfigVersion.cmake
        DESTINATION ${package_folder} COMPONENT library)
install(FILES ${PROJECT_BINARY_DIR}/rvelab.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT library)

if(TARGET rvelab_mpi)
  install(TARGETS rvelab_mpi EXPORT rvelabMpiTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT mpi)
  install(EXPORT rvelabMpiTargets NAMESPACE rvelab:: DESTINATION ${package_folder} COMPONENT mpi)
  install(FILES include/rvelab/rvelab_mpi.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/rvelab COMPONENT mpi)
  configure_file(${PROJECT_SOURCE_DIR}/tools/cmake/rvelab-mpi.pc.in rvelab-mpi.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/rvelab-mpi.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT mpi)
endif()

file(GLOB python_modules CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tools/python/rvelab/*.py)
install(FILES ${PROJECT_SOURCE_DIR}/tools/python/micro_simulation.py DESTINATION lib/python3/dist-packages COMPONENT python)
install(FILES ${python_modules} DESTINATION lib/python3/dist-packages/rvelab COMPONENT python)
file(GLOB fenicsx_modules CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tools/fenicsx/*.py)
install(FILES ${fenicsx_modules} DESTINATION lib/python3/dist-packages/rvelab/fenicsx COMPONENT python)

# The same as a wheel, with libraries, programs, protocols and figures in it: build/release/wheel.
find_program(DEBIAN_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
if(DEBIAN_PYTHON)
  add_custom_target(rvelab_wheel DEPENDS rvelab rvelab-mpm rvelab_shared rvelab_h5 rvelab_protocols
                    COMMAND ${CMAKE_COMMAND} -E env RVELAB_BUILD=${PROJECT_BINARY_DIR} ${DEBIAN_PYTHON} -B
                            ${PROJECT_SOURCE_DIR}/tools/python/wheel_builder.py VERBATIM)
endif()

# Programs, which find their libraries beside them, and what they read.
set(installed_programs rvelab-mpm)
if(TARGET rvelab-mpm-mpi)
  list(APPEND installed_programs rvelab-mpm-mpi)
  install(TARGETS rvelab-mpm-mpi RUNTIME DESTINATION bin COMPONENT mpi)
endif()
if(TARGET rvelab-voids)
  list(APPEND installed_programs rvelab-voids)
  install(TARGETS rvelab-voids RUNTIME DESTINATION bin COMPONENT voids)
endif()
set_target_properties(${installed_programs} PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
install(TARGETS rvelab rvelab-mpm RUNTIME DESTINATION bin COMPONENT program)
install(TARGETS rvelab_umat LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT umat)
install(DIRECTORY protocols/ DESTINATION share/rvelab/protocols COMPONENT program FILES_MATCHING PATTERN *.toml PATTERN *.csv)
install(PROGRAMS ${plot_scripts} DESTINATION share/rvelab/plot COMPONENT program)

# Manual pages and completions, of what the programs say of themselves: where they can run.
set(documented rvelab rvelab-mpm)
if(TARGET rvelab-voids)
  list(APPEND documented rvelab-voids)
endif()
if(NOT CMAKE_CROSSCOMPILING)
  set(manual ${PROJECT_BINARY_DIR}/manual)
  set(manual_pages)
  set(documented_files)
  foreach(program IN LISTS documented)
    list(APPEND manual_pages ${manual}/${program}.1 ${manual}/${program}.bash)
    list(APPEND documented_files $<TARGET_FILE:${program}>)
    set(component program)
    if(program STREQUAL "rvelab-voids")
      set(component voids)
    endif()
    install(FILES ${manual}/${program}.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${component})
    install(FILES ${manual}/${program}.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
            RENAME ${program} COMPONENT ${component})
  endforeach()
  add_custom_command(OUTPUT ${manual_pages} DEPENDS ${documented} tools/cmake/manual
                     COMMAND ${PROJECT_SOURCE_DIR}/tools/cmake/manual ${manual} ${documented_files} VERBATIM)
  # Pages of the manual that the programs and the header write themselves, where there is a python3.
  find_program(RVELAB_PYTHON3 python3)
  if(RVELAB_PYTHON3)
    set(written ${manual}/keys.md ${manual}/commands.md ${manual}/c_api.md)
    add_custom_command(OUTPUT ${written} DEPENDS ${documented} tools/manual/generated.py include/rvelab/rvelab.h
                       COMMAND ${RVELAB_PYTHON3} -B ${PROJECT_SOURCE_DIR}/tools/manual/generated.py ${PROJECT_BINARY_DIR}
                               ${manual} VERBATIM)
    install(FILES ${written} DESTINATION ${CMAKE_INSTALL_DOCDIR}/tools/manual/pages COMPONENT program)
    list(APPEND manual_pages ${written})
  endif()
  add_custom_target(rvelab_manual ALL DEPENDS ${manual_pages})
endif()
if(TARGET rvelab-mpm-mpi)
  file(CONFIGURE OUTPUT rvelab-mpm-mpi.1 CONTENT ".so man1/rvelab-mpm.1\n")
  install(FILES ${PROJECT_BINARY_DIR}/rvelab-mpm-mpi.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT mpi)
endif()

# All that is installed.
set(packaged rvelab rvelab-mpm rvelab_shared rvelab_h5 rvelab_umat rvelab_protocols)
foreach(target IN ITEMS rvelab-voids rvelab_mpi rvelab-mpm-mpi rvelab_manual)
  if(TARGET ${target})
    list(APPEND packaged ${target})
  endif()
endforeach()
add_custom_target(rvelab_packaged DEPENDS ${packaged})

# What to read: README.md and those that it leads to, in the folders that their links name; licences, also of what is
# compiled in; examples and notebooks.
file(GLOB_RECURSE readmes RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS include/*README.md rvelab/*README.md
     protocols/*README.md tests/*README.md tools/*README.md tools/bench/*.md tools/manual/pages/*.md)
list(FILTER readmes EXCLUDE REGEX node_modules)  # of a page that was built here
foreach(readme IN LISTS readmes ITEMS README.md CHANGELOG.md CITATION.cff)
  get_filename_component(place ${readme} DIRECTORY)
  install(FILES ${PROJECT_SOURCE_DIR}/${readme} DESTINATION ${CMAKE_INSTALL_DOCDIR}/${place} COMPONENT program)
endforeach()
foreach(place IN ITEMS tools/examples tools/examples/precice)
  file(GLOB examples LIST_DIRECTORIES false CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${place}/*)
  install(FILES ${examples} DESTINATION ${CMAKE_INSTALL_DOCDIR}/${place} COMPONENT program)
endforeach()
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/tools/cmake/copyright_voids DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/rvelab-voids
        RENAME copyright COMPONENT voids)
set(contained libeigen3-dev libcli11-dev nlohmann-json3-dev libtomlplusplus-dev)
if(RVELAB_PORTABLE)
  list(APPEND contained gcc-12-base)
  install(FILES ${portable_libraries}/licences/hdf5 ${portable_libraries}/licences/zlib
          DESTINATION ${CMAKE_INSTALL_DOCDIR}/licences COMPONENT program)
endif()
foreach(package IN LISTS contained)
  if(EXISTS /usr/share/doc/${package}/copyright)  # as on Debian
    install(FILES /usr/share/doc/${package}/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR}/licences RENAME ${package}
            COMPONENT program)
  endif()
endforeach()

# A Debian package of all of it, one of librvelab-mpi, which needs Open MPI, and one of rvelab-voids, which is under the
# GPL: cpack --config build/release/CPackConfig.cmake; tools/package makes those that are given away.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME rvelab)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "granular specimens in a periodic cell: laboratory, library, Python module")
set(CPACK_PACKAGE_CONTACT "The rvelab authors")
set(CPACK_PACKAGE_FILE_NAME rvelab)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/lib)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-numpy, python3-h5py, python3-matplotlib")
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_MAIN_PACKAGE_NAME rvelab)
set(CPACK_DEBIAN_MAIN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_MAIN_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/tools/cmake/prerm)
set(CPACK_DEBIAN_MPI_PACKAGE_NAME rvelab-mpi)
set(CPACK_DEBIAN_MPI_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_MPI_PACKAGE_DEPENDS "rvelab (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_MPI_PACKAGE_RECOMMENDS openmpi-bin)
set(CPACK_DEBIAN_VOIDS_PACKAGE_NAME rvelab-voids)
set(CPACK_DEBIAN_VOIDS_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_VOIDS_PACKAGE_DEPENDS "rvelab (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_VOIDS_PACKAGE_RECOMMENDS "")
set(CPACK_COMPONENT_VOIDS_DESCRIPTION "local void ratios, pore sizes and permeability of granular specimens")
set(CPACK_COMPONENT_MPI_DESCRIPTION "one pool of granular specimens over many processes, by Open MPI")
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
include(CPack)
cpack_add_component_group(main)
foreach(component IN ITEMS library umat python program)
  cpack_add_component(${component} GROUP main)
endforeach()
