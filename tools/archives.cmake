# SPDX-License-Identifier: BSD-3-Clause
# Links what Debian has as archives into the programs. Loading shared libraries is a part of what a program of the chain
# takes on a small mesh: mremesh on a sphere of 1,280 triangles takes 84 ms of processor time with archives and 111 ms
# without (medians of 9 interleaved runs); on the bunny (69,000 triangles) 3.40 s and 3.55 s.
option(MESHPIPE_ARCHIVES "link what Debian has as archives (libstdc++, libgomp, zlib, pugixml) into the programs" ON)
set(zlib ZLIB::ZLIB)
set(pugixml pugixml::pugixml)
if(MESHPIPE_ARCHIVES AND NOT MESHPIPE_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=libgomp.a OUTPUT_VARIABLE gomp_archive OUTPUT_STRIP_TRAILING_WHITESPACE)
  find_library(ZLIB_ARCHIVE libz.a)
  find_library(PUGIXML_ARCHIVE libpugixml.a)
  if(IS_ABSOLUTE "${gomp_archive}" AND ZLIB_ARCHIVE AND PUGIXML_ARCHIVE)
    set(zlib ${ZLIB_ARCHIVE})
    set(pugixml ${PUGIXML_ARCHIVE})
    set(gomp ${gomp_archive})
  endif()
endif()
