# cmake -DNPM=... -DFROM=... -DTO=... -P fetch.cmake
file(COPY ${FROM}/package.json ${FROM}/package-lock.json ${FROM}/.npmrc DESTINATION ${TO})
execute_process(COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error
  WORKING_DIRECTORY ${TO} RESULT_VARIABLE failed OUTPUT_VARIABLE said ERROR_VARIABLE said)
if(failed)
  message(FATAL_ERROR "npm could not fetch the report's packages (needed once, by network or npm cache):\n${said}")
endif()
# npm keeps the packages' own dates; the build needs to know that they are newer than the lock file.
file(GLOB_RECURSE fetched ${TO}/node_modules/chart.js/dist/chart.umd.min.js ${TO}/node_modules/img-comparison-slider/dist/*)
file(TOUCH ${fetched})
