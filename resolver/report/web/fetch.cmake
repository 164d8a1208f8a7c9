# cmake -DNPM=... -DFROM=... -DTO=... -DBUILD=... -P fetch.cmake
file(COPY ${FROM}/package.json ${FROM}/package-lock.json ${FROM}/.npmrc DESTINATION ${TO})
# Two quick tries more: npm's own pauses between them are a silent minute where there is no network.
execute_process(COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error
    --fetch-retry-mintimeout=1000 --fetch-retry-maxtimeout=3000
  WORKING_DIRECTORY ${TO} RESULT_VARIABLE failed OUTPUT_VARIABLE said ERROR_VARIABLE said)
if(failed)
  file(READ ${FROM}/package.json manifest)
  string(JSON count LENGTH "${manifest}" dependencies)
  math(EXPR last "${count} - 1")
  foreach(i RANGE ${last})
    string(JSON name MEMBER "${manifest}" dependencies ${i})
    string(JSON version GET "${manifest}" dependencies ${name})
    list(APPEND packages "${name} ${version}")
  endforeach()
  list(JOIN packages ", " packages)
  string(REGEX REPLACE "\n[^\n]*    at [^\n]*" "" said "${said}")  # npm's own stack
  string(STRIP "${said}" said)
  message(NOTICE "
npm could not fetch the report's packages: ${packages}. A build needs them once, from the network.
  Behind a proxy:        set HTTPS_PROXY, and if the proxy signs with a certificate of its own, NODE_EXTRA_CA_CERTS=FILE.pem; build again.
  Without a network:     elsewhere, with package.json and package-lock.json of ${FROM},
                         run `npm ci --ignore-scripts`, bring its node_modules here and build again after
                         cmake -DAA_WEB_PACKAGES=/path/to/node_modules ${BUILD}
npm said:
${said}
")
  message(FATAL_ERROR "the report's packages are missing (the ways out: above)")
endif()
# npm keeps the packages' own dates; the build needs to know that they are newer than the lock file.
file(GLOB_RECURSE fetched ${TO}/node_modules/chart.js/dist/chart.umd.min.js)
file(TOUCH ${fetched})
