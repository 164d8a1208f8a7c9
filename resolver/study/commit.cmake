# cmake -DSOURCE=... -DHEADER=... -P commit.cmake: the header that names the last commit that touched what the program is
# made of; empty outside of git. Left as it is where nothing changed, so that the program stays the same file.
set(commit)
if(EXISTS ${SOURCE}/.git)
  execute_process(COMMAND git log -1 --format=%h --abbrev=12 -- resolver shaders CMakeLists.txt
    WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
set(text "#define AA_COMMIT \"${commit}\"\n")
set(before)
if(EXISTS ${HEADER})
  file(READ ${HEADER} before)
endif()
if(NOT before STREQUAL text)
  file(WRITE ${HEADER} "${text}")
endif()
