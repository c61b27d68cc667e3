# Install, uninstall, and the configuration that find_package(Certa CONFIG) reads.
include(CMakePackageConfigHelpers)
set(certa_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Certa)

install(TARGETS certa EXPORT CertaTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/certa DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(EXPORT CertaTargets NAMESPACE Certa:: DESTINATION ${certa_package_dir})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
if(TARGET certa_cli)
  # The command finds a shared library beside it wherever the prefix is moved to.
  set_target_properties(certa_cli PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
  install(TARGETS certa_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  # The manual page and the completion are the program's own words.
  set(certa_words ${PROJECT_BINARY_DIR}/words)
  add_custom_command(OUTPUT ${certa_words}/certa.1 ${certa_words}/certa.bash
    COMMAND ${CMAKE_COMMAND} -E make_directory ${certa_words}
    COMMAND certa_cli manual > ${certa_words}/certa.1
    COMMAND certa_cli completion > ${certa_words}/certa.bash
    VERBATIM)
  add_custom_target(certa_words ALL DEPENDS ${certa_words}/certa.1 ${certa_words}/certa.bash)
  install(FILES ${certa_words}/certa.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
  install(FILES ${certa_words}/certa.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME certa)
endif()
if(CERTA_BUILD_PYTHON)
  if(BUILD_SHARED_LIBS)
    # The module finds the library wherever the prefix is moved to.
    file(RELATIVE_PATH to_library /prefix/${CERTA_PYTHON_INSTALL_DIR}/certa /prefix/${CMAKE_INSTALL_LIBDIR})
    set_target_properties(certa_python PROPERTIES INSTALL_RPATH "$ORIGIN/${to_library}")
  endif()
  install(TARGETS certa_python LIBRARY DESTINATION ${CERTA_PYTHON_INSTALL_DIR}/certa COMPONENT python)
  install(DIRECTORY ${PROJECT_BINARY_DIR}/python/certa DESTINATION ${CERTA_PYTHON_INSTALL_DIR} COMPONENT python
    FILES_MATCHING PATTERN "*.py" PATTERN "*.pyi" PATTERN "py.typed" PATTERN __pycache__ EXCLUDE)
endif()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/CertaConfig.cmake.in ${PROJECT_BINARY_DIR}/CertaConfig.cmake
  INSTALL_DESTINATION ${certa_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/CertaConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/CertaConfig.cmake ${PROJECT_BINARY_DIR}/CertaConfigVersion.cmake
  DESTINATION ${certa_package_dir})

if(PROJECT_IS_TOP_LEVEL)
  add_custom_target(uninstall
    COMMAND ${CMAKE_COMMAND} -DMANIFEST=${PROJECT_BINARY_DIR}/install_manifest.txt -P ${PROJECT_SOURCE_DIR}/cmake/uninstall.cmake
    VERBATIM)
endif()

# `cpack -G DEB` in the build folder: a package with the command, the library, its headers and, if built, the module.
if(PROJECT_IS_TOP_LEVEL)
  set(CPACK_PACKAGE_NAME certa)
  set(CPACK_PACKAGE_VENDOR "The Certa developers")
  set(CPACK_PACKAGE_CONTACT "The Certa developers <certa@localhost>")
  set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
  set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
  set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
  set(CPACK_GENERATOR DEB)
  set(CPACK_STRIP_FILES ON)
  set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
  set(CPACK_DEBIAN_PACKAGE_SECTION math)
  find_program(CERTA_SHLIBDEPS dpkg-shlibdeps)
  if(CERTA_SHLIBDEPS)
    set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
  else()
    set(CPACK_DEBIAN_PACKAGE_DEPENDS "libc6, libstdc++6, libtbb12, libmpfi0, libmpfr6, libgmp10, libgmpxx4ldbl, zlib1g")
  endif()
  # What links the static library, and what the module imports.
  set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libtbb-dev, libmpfi-dev, libgmp-dev, libcgal-dev, python3-numpy")
  if(CERTA_BUILD_PYTHON)
    configure_file(${PROJECT_SOURCE_DIR}/cmake/prerm.in ${PROJECT_BINARY_DIR}/debian/prerm @ONLY
      FILE_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
    set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/debian/prerm)
  endif()
  include(CPack)
endif()
