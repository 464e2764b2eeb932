# SPDX-License-Identifier: BSD-3-Clause
# The three kinds of target of this project: a library a subject, a program, a test a folder.
# Headers are included by their path from the repository: #include "daemon/geometry/pose.hpp".

add_library(handeye_build_options INTERFACE)
target_include_directories(handeye_build_options INTERFACE ${CMAKE_SOURCE_DIR})
target_compile_options(
  handeye_build_options
  # Designated initialisers leave out what has a default: that is their point.
  INTERFACE -Wno-missing-field-initializers -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-qual -Werror)
if(HANDEYE_SANITIZE)
  target_compile_options(handeye_build_options INTERFACE -fsanitize=${HANDEYE_SANITIZE} -fno-omit-frame-pointer
                                                         -fno-sanitize-recover=all)
  target_link_options(handeye_build_options INTERFACE -fsanitize=${HANDEYE_SANITIZE})
endif()
if(HANDEYE_COVERAGE)
  target_compile_options(handeye_build_options INTERFACE --coverage -fprofile-update=atomic)
  target_link_options(handeye_build_options INTERFACE --coverage)
endif()

# handeye_library(NAME SOURCES ... LINKS ... [PRIVATE_LINKS ...]): static library handeye_NAME, alias handeye::NAME.
function(handeye_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
  add_library(handeye_${name} STATIC ${ARG_SOURCES})
  add_library(handeye::${name} ALIAS handeye_${name})
  target_link_libraries(handeye_${name} PUBLIC ${ARG_LINKS} PRIVATE handeye_build_options ${ARG_PRIVATE_LINKS})
  # Users of the library need the include root, not the warnings.
  target_include_directories(handeye_${name} PUBLIC ${CMAKE_SOURCE_DIR})
endfunction()

# handeye_program(NAME SOURCES ... LINKS ...): an installed program in build/PRESET/bin.
function(handeye_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINKS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE handeye_build_options ${ARG_LINKS})
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT daemon)
endfunction()

# handeye_test(NAME [TOGETHER] SOURCES ... LINKS ...): one GoogleTest program; every TEST in it is one ctest test. TOGETHER:
# the program is one, for its TESTs share what takes long to make.
function(handeye_test name)
  cmake_parse_arguments(ARG "TOGETHER" "" "SOURCES;LINKS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE handeye_build_options GTest::gtest_main GTest::gmock ${ARG_LINKS})
  if(ARG_TOGETHER)
    add_test(NAME ${name} COMMAND ${name})
    set_tests_properties(${name} PROPERTIES TIMEOUT 300)
    return()
  endif()
  gtest_discover_tests(
    ${name}
    DISCOVERY_TIMEOUT 60
    PROPERTIES TIMEOUT 300 SKIP_REGULAR_EXPRESSION "\\[  SKIPPED \\]")
endfunction()
