# SPDX-License-Identifier: LGPL-2.1-or-later
# Writes the header OUTPUT with the commit of the sources in SOURCE, unless it holds that already.
execute_process(
  COMMAND git -c safe.directory=* -C ${SOURCE} describe --always --dirty --abbrev=40 --exclude=*
  OUTPUT_VARIABLE commit
  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
  set(commit "unknown")
endif()
set(text
    "// The commit that this was built from.\n#pragma once\n\nnamespace softcell\n{\n  constexpr const char *commit = \"${commit}\";\n} // namespace softcell\n"
)
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} old)
endif()
if(NOT "${old}" STREQUAL "${text}")
  file(WRITE ${OUTPUT} "${text}")
endif()
