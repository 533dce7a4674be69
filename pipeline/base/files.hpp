#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

// Reading and writing of files, which every program of this project uses.

namespace houghstream {

/// Throws InputError unless `file` is an ordinary file that exists; `expected` names what was wanted ("an LCM log").
/// Called before the file is opened, since opening a named pipe would wait for a writer.
void require_regular_file(const std::filesystem::path& file, const char* expected);

/// Returns all bytes of an ordinary file. Throws InputError where it is not one, or cannot be read to its end.
std::string read_file(const std::filesystem::path& file, const char* expected);

// Checks the nesting depth of a text before it is parsed; the text may be JSON or YAML.

/// Throws InputError where the JSON holds lists or objects nested more than 64 times, since reading, copying and
/// printing it recurse as deep.
void check_json_nesting(std::string_view text, const std::string& source);

/// Ending of the name of a file that is being written.
inline constexpr const char* kPartialEnding = ".partial";

/// Throws InputError where the output, or the FILE.partial that it is first written to, is the input itself, by
/// whatever name, or lies in it where the input is a folder. An empty output is none.
void require_other_file(const std::filesystem::path& output, const std::filesystem::path& input);

/// Throws InputError where the file could not be written: it is a folder, or its own folder is missing or takes no
/// files. Asked before the work whose result is to go there.
void require_writable(const std::filesystem::path& file);

/// Throws InputError where the folder could not be written; it and its parents may be missing. Makes no folder.
void require_writable_folder(const std::filesystem::path& folder);

/// Waits until the file's data, or the names in the folder, are on the disk, so that they survive a power cut. Throws
/// InputError where the disk fails; a file system that cannot synchronise is accepted as it is.
void sync_to_disk(const std::filesystem::path& path);

/// Treatment of existing files: of FILE, and of the FILE.partial that a killed program left.
enum class Existing {
  kReplaced,           ///< both go: what is written can be had again
  kRecordingReplaced,  ///< FILE is replaced; what a killed program recorded stays, as FILE.interrupted-N
  kRecordingKept       ///< both stay: the new recording takes the next number, FILE_2, FILE_3, ...
};

/// Returns the treatment that the option --replace asks for, for a recording.
constexpr Existing existing_of_recording(bool replace) {
  return replace ? Existing::kRecordingReplaced : Existing::kRecordingKept;
}

/// Writes a file atomically: data go to FILE.partial, and commit() renames it to FILE. Before commit(), and after a
/// failure, FILE keeps its previous content. A FILE.partial that a killed program left is removed by the next one that
/// writes FILE, or, of a recording, renamed (recording_names.hpp). Where FILE is a device or a pipe, it is written as
/// it is. Not thread-safe.
class AtomicFile {
 public:
  /// `ending` is that of the partial file, for libraries that choose the format by it. Throws InputError where the file
  /// cannot be made, or another program is writing FILE.
  explicit AtomicFile(const std::filesystem::path& file, const std::string& ending = kPartialEnding,
                      Existing existing = Existing::kReplaced);
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  AtomicFile& operator=(AtomicFile&&) = delete;
  ~AtomicFile();  ///< removes what was neither published nor kept

  /// Returns FILE, with symbolic links followed.
  const std::filesystem::path& wanted() const { return wanted_; }
  /// Returns the final name: FILE, or the next number of a recording.
  const std::filesystem::path& file() const { return file_; }
  /// The name that was given to what a killed program had recorded.
  const std::optional<std::filesystem::path>& interrupted() const { return interrupted_; }
  /// Returns the name of the file to write, which is empty at first.
  const std::filesystem::path& partial() const { return partial_; }

  /// Renames the partial file, which its writer has closed, to FILE, and returns once it is on the disk. An older FILE
  /// is replaced only once the new one is on the disk. Where there is none, the rename comes first, so that a program
  /// that is killed while a slow disk syncs a long recording leaves it whole. Throws InputError; the data can then
  /// still be kept by keep_partial().
  void commit();
  [[deprecated("is commit() now")]] void publish() { commit(); }
  /// Keeps the data as FILE.partial, for data that cannot be had again, like a recording on a full disk.
  void keep_partial();
  [[deprecated("is keep_partial() now")]] void keep() { keep_partial(); }

 private:
  friend void write_file_atomically(const std::filesystem::path& file, std::string_view bytes);

  bool put_into_place();
  void release();
  bool rename_into_place();

  std::filesystem::path wanted_;   // FILE with symbolic links followed
  std::filesystem::path file_;     // = wanted_, or its next number
  std::filesystem::path partial_;  // = file_ for a device
  Existing existing_ = Existing::kReplaced;
  std::optional<std::filesystem::path> interrupted_;
  int lock_ = -1;  // the open file, locked; ends with the process, however that ends
};

/// Writes a whole file in this way. One that replaces nothing is not waited for: images are written by the thousand,
/// and who puts them into a folder that replaces another one waits for all at once (folder_exchange.hpp). Throws
/// InputError.
void write_file_atomically(const std::filesystem::path& file, std::string_view bytes);

// The names of before, for one release.
using WholeFile [[deprecated("is AtomicFile now")]] = AtomicFile;

}  // namespace houghstream
