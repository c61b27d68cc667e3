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
