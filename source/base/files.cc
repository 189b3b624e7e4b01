// SPDX-License-Identifier: LGPL-2.1-or-later
// Files that are to be read, and text files written so that a reader never sees half of one.

#include <softcell/base/files.h>

#include <softcell/base/exceptions.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

namespace softcell
{
  namespace
  {
    /// @param error as errno has it.
    [[noreturn]] void throw_not_written(const std::string &file, const int error)
    {
      throw BadInput("'" + file + "' cannot be written (" + std::strerror(error) +
                     "); give a folder with room and permission by --output DIR.");
    }
  } // namespace

  void check_file(const std::string &place, const std::string &file)
  {
    namespace fs = std::filesystem;
    std::error_code error;
    if (fs::is_directory(file, error))
      throw BadInput(place + " is a folder; name a file in it.");
    if (!fs::exists(file, error))
      throw BadInput(place + ": there is no such file as " +
                     fs::absolute(file, error).lexically_normal().string() + ".");
    if (!std::ifstream(file))
      throw BadInput(place + " cannot be opened; check its permissions.");
  }

  void write_file(const std::string &file, const std::string &text)
  {
    const std::string part = file + ".part";
    errno                  = 0;
    std::ofstream out(part, std::ios::binary);
    out << text;
    out.close();
    if (!out || std::rename(part.c_str(), file.c_str()) != 0)
    {
      const int error = errno;
      std::remove(part.c_str());
      throw_not_written(file, error);
    }
  }

  GrowingFile::GrowingFile(const std::string &file) : file_(file)
  {
    errno = 0;
    out_.open(file, std::ios::binary);
    if (!out_)
      throw_not_written(file_, errno);
  }

  void GrowingFile::add(const std::string &lines)
  {
    errno = 0;
    if (!(out_ << lines << std::flush))
      throw_not_written(file_, errno);
  }

  void make_folder(const std::string &folder)
  {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
      throw BadInput("The folder '" + folder + "' cannot be made (" + error.message() +
                     "); give another one by --output DIR.");
  }

  void check_folder(const std::string &folder)
  {
    namespace fs = std::filesystem;
    std::vector<fs::path> missing; // the innermost one first
    std::error_code error;
    for (fs::path path = folder; !path.empty() && !fs::exists(path, error);
         path          = path.parent_path())
      missing.push_back(path);
    make_folder(folder);
    for (const fs::path &path : missing)
      fs::remove(path, error);
  }
} // namespace softcell
