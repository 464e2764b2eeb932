# SPDX-License-Identifier: BSD-3-Clause
# Two Debian packages, by CPack: `handeyed` (programs, units, configuration, manuals) and `libhandeye-client-dev` (what
# navigation software links). ./run package makes them.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME handeyed)
set(CPACK_PACKAGE_VENDOR "the handeyed developers")
set(CPACK_PACKAGE_CONTACT "the handeyed developers <packages@handeyed.example>")
# Each package has a description of its own, summary first.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/package)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL daemon client)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
# By what the programs link: the exact packages, with the least versions that have what is used.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)

set(CPACK_DEBIAN_DAEMON_PACKAGE_NAME handeyed)
set(CPACK_DEBIAN_DAEMON_PACKAGE_SECTION science)
set(CPACK_COMPONENT_DAEMON_DESCRIPTION
    "hand-eye calibration service for tracked endoscopes
Finds out where the camera of a tracked endoscope is, without a calibration
pattern: from the tracker's packets (ART DTrack) and the camera's images
while the scope is moved. Answers requests over LCM with the transformation,
its uncertainty, and accepted or the reason why not; then publishes the
camera's pose with every frame. Comes with a client and a simulator.")
# iproute2: the multicast route.
set(CPACK_DEBIAN_DAEMON_PACKAGE_DEPENDS "iproute2, init-system-helpers (>= 1.54~)")
set(CPACK_DEBIAN_DAEMON_PACKAGE_RECOMMENDS "udev")
set(CPACK_DEBIAN_DAEMON_PACKAGE_CONTROL_EXTRA
    ${CMAKE_SOURCE_DIR}/systemd/debian/conffiles ${CMAKE_SOURCE_DIR}/systemd/debian/postinst
    ${CMAKE_SOURCE_DIR}/systemd/debian/prerm ${CMAKE_SOURCE_DIR}/systemd/debian/postrm)

set(CPACK_DEBIAN_CLIENT_PACKAGE_NAME libhandeye-client-dev)
set(CPACK_DEBIAN_CLIENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_CLIENT_PACKAGE_DEPENDS "liblcm-dev")
set(CPACK_DEBIAN_CLIENT_PACKAGE_RECOMMENDS "handeyed")
set(CPACK_COMPONENT_CLIENT_DESCRIPTION
    "client library for the hand-eye calibration service handeyed
Headers, message types and static libraries for navigation software that
asks handeyed for a calibration over LCM and follows the camera's pose.")

# What Debian's policy wants of every package: copyright, our changelog, and Debian's own.
find_program(GZIP gzip REQUIRED)
set(CHANGELOGS ${CMAKE_BINARY_DIR}/changelog.gz ${CMAKE_BINARY_DIR}/changelog.Debian.gz)
configure_file(${CMAKE_SOURCE_DIR}/systemd/debian/changelog.in ${CMAKE_BINARY_DIR}/changelog.Debian @ONLY)
add_custom_command(
  OUTPUT ${CHANGELOGS}
  COMMAND ${GZIP} -9 -n -c ${CMAKE_SOURCE_DIR}/CHANGELOG.md > ${CMAKE_BINARY_DIR}/changelog.gz
  COMMAND ${GZIP} -9 -n -c ${CMAKE_BINARY_DIR}/changelog.Debian > ${CMAKE_BINARY_DIR}/changelog.Debian.gz
  DEPENDS ${CMAKE_SOURCE_DIR}/CHANGELOG.md ${CMAKE_BINARY_DIR}/changelog.Debian
  COMMENT "Compressing the changelogs")
add_custom_target(changelog ALL DEPENDS ${CHANGELOGS})
foreach(package handeyed:daemon libhandeye-client-dev:client)
  string(REPLACE ":" ";" parts ${package})
  list(GET parts 0 name)
  list(GET parts 1 component)
  set(documents share/doc/${name})
  install(FILES ${CMAKE_SOURCE_DIR}/LICENSE DESTINATION ${documents} COMPONENT ${component} RENAME copyright)
  install(FILES ${CHANGELOGS} DESTINATION ${documents} COMPONENT ${component})
endforeach()
include(CPack)
