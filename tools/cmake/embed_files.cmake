# Writes a C++ source that holds files byte by byte:
#   cmake -DFOLDER=DIR -DFILES=a.xml,data/b.stl -DOUTPUT=x.cpp -P embed_files.cmake
string(REPLACE "," ";" files "${FILES}")
set(text "#include \"app/template_files.h\"\n\nnamespace fppg\n{\n\nnamespace\n{\n\nusing namespace std::string_view_literals;\n\nconstexpr TemplateFile files[] = {\n")
foreach(file IN LISTS files)
  file(READ "${FOLDER}/${file}" bytes HEX)
  # Every byte is an escape, so that none can run into the next one.
  string(REGEX REPLACE "(..)" "\\\\x\\1" bytes "${bytes}")
  string(APPEND text "    {\"${file}\"sv, \"${bytes}\"sv},\n")
endforeach()
string(APPEND text "};\n\n} // namespace\n\nstd::span<const TemplateFile> template_files()\n{\n    return files;\n}\n\n} // namespace fppg\n")
file(WRITE "${OUTPUT}" "${text}")
