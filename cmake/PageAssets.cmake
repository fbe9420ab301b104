# SPDX-License-Identifier: Apache-2.0
# Files embedded in the program, as one C++ source: page.css, figure.js, the live page's script, and uPlot,
# which scripts/setup.sh fetches (src/tools/chart/README.md; without uPlot, pages have tables and sentences only); the
# evaluator, its second derivatives and the reader of blocks that exported C files hold; and the vehicle of `kelpie live --demo`.
set(KELPIE_UPLOT "${PROJECT_SOURCE_DIR}/build/uplot/package" CACHE PATH
    "Where the npm package uplot was unpacked")
set(KELPIE_PAGE_STYLE "${PROJECT_SOURCE_DIR}/src/tools/chart/page.css")
set(KELPIE_FIGURE_SCRIPT "${PROJECT_SOURCE_DIR}/src/tools/chart/figure.js")
set(KELPIE_LIVE_SCRIPT "${PROJECT_SOURCE_DIR}/src/live/web/live.js")
set(KELPIE_LIBRARY_SCRIPT "${KELPIE_UPLOT}/dist/uPlot.iife.min.js")
set(KELPIE_LIBRARY_STYLE "${KELPIE_UPLOT}/dist/uPlot.min.css")
set(KELPIE_LIBRARY_LICENCE "${KELPIE_UPLOT}/LICENSE")
set(KELPIE_MODEL_EVALUATOR "${PROJECT_SOURCE_DIR}/src/tools/format/model_eval.inc")
set(KELPIE_MODEL_CURVE "${PROJECT_SOURCE_DIR}/src/tools/format/model_curve.inc")
set(KELPIE_MODEL_BLOCK "${PROJECT_SOURCE_DIR}/src/tools/format/model_block.inc")

set(KELPIE_DAGON "${PROJECT_SOURCE_DIR}/vehicles/dagon.toml")

set(KELPIE_HAVE_UPLOT OFF)
if(EXISTS "${KELPIE_LIBRARY_SCRIPT}")
  set(KELPIE_HAVE_UPLOT ON)
endif()
string(CONCAT page_assets "// Made by cmake/PageAssets.cmake.\n"
       "#include \"chart/page_assets.hpp\"\n#include \"format/c_templates.hpp\"\n"
       "#include \"simulator/dagon.hpp\"\n\n")
foreach(name IN ITEMS PageStyle FigureScript LiveScript LibraryScript LibraryStyle LibraryLicence
        ModelEvaluator ModelCurve ModelBlock Dagon)
  set(room chart)
  if(name MATCHES "^Model")
    set(room format)
  elseif(name STREQUAL "Dagon")
    set(room simulator)
  endif()
  string(REGEX REPLACE "([a-z])([A-Z])" "\\1_\\2" file "${name}")
  string(TOUPPER "KELPIE_${file}" file)
  set(content "")
  if(EXISTS "${${file}}")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${${file}}")
    file(READ "${${file}}" content)
  elseif(name STREQUAL "LibraryScript")
    message(STATUS "kelpie: built without figures in its pages: there is no ${${file}}. "
                   "scripts/setup.sh fetches it")
  endif()
  string(APPEND page_assets
    "constexpr std::string_view kelpie::${room}::k${name} = R\"kelpie(${content})kelpie\";\n")
endforeach()
set(KELPIE_PAGE_ASSETS "${PROJECT_BINARY_DIR}/page_assets.cpp")
set(before "")
if(EXISTS "${KELPIE_PAGE_ASSETS}")
  file(READ "${KELPIE_PAGE_ASSETS}" before)
endif()
if(NOT before STREQUAL page_assets)
  file(WRITE "${KELPIE_PAGE_ASSETS}" "${page_assets}")
endif()
