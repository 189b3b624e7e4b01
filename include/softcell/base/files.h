// SPDX-License-Identifier: LGPL-2.1-or-later
// Files that are to be read, and text files of which a reader never sees half, or half a line.
#pragma once

#include <fstream>
#include <string>

namespace softcell
{
  /// Sees whether a file can be read.
  /// @param place  the entry that names it, with its value, or another name for it, for messages.
  /// @throws BadInput with the whole path if not.
  void check_file(const std::string &place, const std::string &file);

  /// Puts the text into the file in one move; what stood there before stays until then.
  /// @throws BadInput if the file cannot be written.
  void write_file(const std::string &file, const std::string &text);

  /// A text file that grows. What was added is there even if the program is killed.
  class GrowingFile
  {
  public:
    /// Begins with an empty file.
    /// @throws BadInput if it cannot be written, as add() does.
    explicit GrowingFile(const std::string &file);
    void add(const std::string &lines);

  private:
    std::string file_;
    std::ofstream out_;
  };

  /// Makes a folder and those above it, unless they are there.
  /// @throws BadInput if it cannot be made.
  void make_folder(const std::string &folder);

  /// Sees whether make_folder() could make it, and leaves nothing behind.
  /// @throws BadInput if not.
  void check_folder(const std::string &folder);
} // namespace softcell
