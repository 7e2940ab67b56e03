# SPDX-License-Identifier: BSD-3-Clause
# Completions, made from --help where there is Python, and the .deb and .tar.gz that cpack makes (scripts/package).
find_package(Python3 COMPONENTS Interpreter)
if(Python3_FOUND)
  set(completions ${CMAKE_BINARY_DIR}/completions)
  add_custom_command(OUTPUT ${completions}/done
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${completions}
    COMMAND ${Python3_EXECUTABLE} ${CMAKE_SOURCE_DIR}/scripts/packages/completions.py ${CMAKE_RUNTIME_OUTPUT_DIRECTORY} ${completions}
    COMMAND ${CMAKE_COMMAND} -E touch ${completions}/done
    DEPENDS ${programs} ${CMAKE_SOURCE_DIR}/scripts/packages/completions.py ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/mremesh)
  add_custom_target(completions ALL DEPENDS ${completions}/done)
  set(MESHPIPE_ZSH_DIR ${CMAKE_INSTALL_DATADIR}/zsh/site-functions CACHE STRING "where zsh looks for completions")
  install(DIRECTORY ${completions}/bash/ DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
  install(DIRECTORY ${completions}/zsh/ DESTINATION ${MESHPIPE_ZSH_DIR})
  install(DIRECTORY ${completions}/fish/ DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
endif()

set(MESHPIPE_DEBIAN OFF CACHE BOOL "install what Debian's policy wants: compressed manuals, changelog, copyright")
if(MESHPIPE_DEBIAN)
  set(MESHPIPE_DOC ${CMAKE_BINARY_DIR}/doc)
  file(MAKE_DIRECTORY ${MESHPIPE_DOC})
  foreach(page ${manuals} ${CMAKE_SOURCE_DIR}/tools/meshpipe.7)
    get_filename_component(name ${page} NAME)
    string(REGEX MATCH "[17]$" section ${name})
    execute_process(COMMAND gzip -9nc ${page} OUTPUT_FILE ${MESHPIPE_DOC}/${name}.gz COMMAND_ERROR_IS_FATAL ANY)
    install(FILES ${MESHPIPE_DOC}/${name}.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man${section})
  endforeach()
  configure_file(${CMAKE_CURRENT_LIST_DIR}/changelog.in ${MESHPIPE_DOC}/changelog @ONLY)
  execute_process(COMMAND gzip -9nc ${MESHPIPE_DOC}/changelog OUTPUT_FILE ${MESHPIPE_DOC}/changelog.Debian.gz COMMAND_ERROR_IS_FATAL ANY)
  install(FILES ${MESHPIPE_DOC}/changelog.Debian.gz ${CMAKE_CURRENT_LIST_DIR}/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})
endif()

set(CPACK_PACKAGE_NAME meshpipe)
set(CPACK_PACKAGE_VENDOR "The meshpipe authors")
set(CPACK_PACKAGE_CONTACT "The meshpipe authors <meshpipe@localhost.localdomain>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "remesh triangulated surfaces for finite elements and CFD")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "Small programs, chained by mremesh, turn an STL, OBJ, PLY or MSH
surface of any genus into a mesh of good triangles with the size asked
for, on the same surface, with its patches and their names, and verify
the result.")
set(CPACK_GENERATOR TGZ)
set(CPACK_PACKAGE_FILE_NAME meshpipe-${PROJECT_VERSION}-linux-${CMAKE_SYSTEM_PROCESSOR})
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "gmsh, tetgen, paraview")
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
include(CPack)
