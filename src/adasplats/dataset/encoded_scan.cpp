// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/encoded_scan.h"

#include "adasplats/dataset/scan_values.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats {

void write_encoded(const std::filesystem::path& folder, std::span<const EncodedFile> files,
                   FileWrites how) {
  for (const EncodedFile& file : files) {
    const std::filesystem::path path = folder / file.name;
    std::error_code ignored;  // the error of the file gives the reason
    if (path.parent_path() != folder && !std::filesystem::is_directory(path.parent_path(), ignored))
      create_folder(path.parent_path());
    if (how == FileWrites::atomic) {
      write_file(path, file.bytes);
    } else {
      write_file_in_place(path, file.bytes);
    }
  }
}

}  // namespace adasplats
