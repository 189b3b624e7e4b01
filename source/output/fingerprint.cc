// SPDX-License-Identifier: LGPL-2.1-or-later
// Hashes what results depend on.

#include <softcell/output/fingerprint.h>

#include <softcell/base/version.h>
#include <softcell/geometry/image.h>
#include <softcell/output/commit.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace softcell
{
  namespace
  {
    /// FNV-1a of 64 bits, the same on all machines.
    std::uint64_t hash(const std::string &text, std::uint64_t value)
    {
      for (const unsigned char c : text)
        value = (value ^ c) * 0x100000001b3;
      return value;
    }

    /// Size and time of change; empty if there is no such file.
    std::string state_of(const std::string &file)
    {
      std::error_code error;
      if (!std::filesystem::is_regular_file(file, error))
        return "";
      const auto time = std::filesystem::last_write_time(file, error).time_since_epoch();
      return std::to_string(std::filesystem::file_size(file, error)) + ' ' +
             std::to_string(time.count());
    }

    std::string program()
    {
      std::string name = std::string(version) + '\n' + commit;
      if (name.find("-dirty") == std::string::npos && name.find("unknown") == std::string::npos)
        return name;
      std::ifstream in("/proc/self/exe", std::ios::binary);
      return name + '\n' + std::string(std::istreambuf_iterator<char>(in), {});
    }
  } // namespace

  std::string fingerprint(const std::vector<std::pair<std::string, std::string>> &values)
  {
    static const std::uint64_t of_program = hash(program(), 0xcbf29ce484222325);
    std::uint64_t value                   = of_program;
    for (const auto &[name, text] : values)
    {
      value                   = hash(name + '=' + text + '\n', value);
      const std::string state = state_of(text);
      value                   = hash(state, value);
      if (!state.empty())
        value = hash(state_of(voxel_file(text)), value);
    }
    char digits[17];
    std::snprintf(digits, sizeof(digits), "%016llx", static_cast<unsigned long long>(value));
    return digits;
  }
} // namespace softcell
