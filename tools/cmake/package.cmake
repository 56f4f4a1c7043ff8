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

# The same as a wheel, with libraries, program, protocols and figures in it: build/release/wheel.
find_program(DEBIAN_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
if(DEBIAN_PYTHON)
  add_custom_target(rvelab_wheel DEPENDS rvelab rvelab_shared rvelab_h5 rvelab_protocols
                    COMMAND ${CMAKE_COMMAND} -E env RVELAB_BUILD=${PROJECT_BINARY_DIR} ${DEBIAN_PYTHON} -B
                            ${PROJECT_SOURCE_DIR}/tools/python/wheel_builder.py VERBATIM)
endif()

# Programs, which find their libraries beside them, and what they read.
file(GLOB scenes CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/protocols/mpm/*.toml)
set(installed_programs rvelab-mpm)
if(TARGET rvelab-mpm-mpi)
  list(APPEND installed_programs rvelab-mpm-mpi)
  install(TARGETS rvelab-mpm-mpi RUNTIME DESTINATION bin COMPONENT mpi)
endif()
if(TARGET rvelab-voids)
  list(APPEND installed_programs rvelab-voids)
  install(TARGETS rvelab-voids RUNTIME DESTINATION bin COMPONENT voids EXCLUDE_FROM_ALL)
endif()
set_target_properties(${installed_programs} PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
install(TARGETS rvelab rvelab-mpm RUNTIME DESTINATION bin COMPONENT program)
install(TARGETS rvelab_umat LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT umat)
install(FILES ${scenes} DESTINATION share/rvelab/protocols/mpm COMPONENT program)
install(FILES ${protocols} DESTINATION share/rvelab/protocols COMPONENT program)
install(FILES ${studies} DESTINATION share/rvelab/protocols/studies COMPONENT program)
install(FILES ${soils} DESTINATION share/rvelab/protocols/soils COMPONENT program)
install(PROGRAMS ${plot_scripts} DESTINATION share/rvelab/plot COMPONENT program)

# Manual page and completion, of what the program says of itself.
set(manual ${PROJECT_BINARY_DIR}/manual)
add_custom_command(OUTPUT ${manual}/rvelab.1 ${manual}/rvelab.bash DEPENDS rvelab tools/cmake/manual
                   COMMAND ${PROJECT_SOURCE_DIR}/tools/cmake/manual $<TARGET_FILE:rvelab> ${manual} VERBATIM)
add_custom_target(rvelab_manual ALL DEPENDS ${manual}/rvelab.1 ${manual}/rvelab.bash)
install(FILES ${manual}/rvelab.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${manual}/rvelab.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME rvelab
        COMPONENT program)

# A Debian package of all of it, and one of librvelab-mpi, which needs Open MPI:
# cpack --config build/release/CPackConfig.cmake (tools/validate package tries it).
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
set(CPACK_DEBIAN_MAIN_FILE_NAME rvelab.deb)
set(CPACK_DEBIAN_MAIN_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/tools/cmake/prerm)
set(CPACK_DEBIAN_MPI_PACKAGE_NAME rvelab-mpi)
set(CPACK_DEBIAN_MPI_FILE_NAME rvelab-mpi.deb)
set(CPACK_DEBIAN_MPI_PACKAGE_DEPENDS "rvelab (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_MPI_PACKAGE_RECOMMENDS openmpi-bin)
set(CPACK_COMPONENT_MPI_DESCRIPTION "one pool of granular specimens over many processes, by Open MPI")
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
include(CPack)
cpack_add_component_group(main)
foreach(component IN ITEMS library umat python program)
  cpack_add_component(${component} GROUP main)
endforeach()
