// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/pictures/layer_files.h"

#include <algorithm>
#include <cstddef>

#include "adasplats/core/error.h"
#include "adasplats/core/words.h"
#include "adasplats/io/arrays/npy.h"
#include "adasplats/io/arrays/png.h"
#include "adasplats/io/base/table.h"

namespace adasplats {

namespace {

namespace fs = std::filesystem;

fs::path layer_file(const fs::path& picture, ImageLayer layer, const char* extension) {
  fs::path file = picture;
  file.replace_extension();
  file += "." + std::string(word_of(layer, kImageLayers)) + extension;
  return file;
}

bool has_png(ImageLayer layer) {
  return layer != ImageLayer::normal && layer != ImageLayer::primitive;
}

/// Writes the layers of one picture.
class LayerWriter {
 public:
  LayerWriter(const fs::path& picture, const LayerImages& images)
      : picture_(picture), images_(images) {}

  std::uint64_t write() const {
    std::uint64_t clipped = write_metres(ImageLayer::depth, images_.depth_m);
    clipped += write_metres(ImageLayer::range, images_.range_m);
    write_array(ImageLayer::normal, images_.normals, 3);
    write_array(ImageLayer::primitive, images_.primitives, 1);
    write_array(ImageLayer::class_id, images_.classes, 1);
    if (images_.classes.empty()) return clipped;
    std::vector<std::uint16_t> levels;
    levels.reserve(images_.classes.size());
    for (const std::int32_t id : images_.classes)
      levels.push_back(static_cast<std::uint16_t>(std::max(id, 0)));
    write_levels(ImageLayer::class_id, levels);
    return clipped;
  }

 private:
  template <class T>
  void write_array(ImageLayer layer, const std::vector<T>& values, std::size_t channels) const {
    if (values.empty()) return;
    NpyArray array;
    array.type = column_type<T>();
    array.shape = {static_cast<std::size_t>(images_.height),
                   static_cast<std::size_t>(images_.width)};
    if (channels > 1) array.shape.push_back(channels);
    array.data = values.data();
    write_npy(layer_file(picture_, layer, ".npy"), array);
  }

  std::uint64_t write_metres(ImageLayer layer, const std::vector<float>& metres) const {
    if (metres.empty()) return 0;
    write_array(layer, metres, 1);
    const Millimetres mm = millimetres_of(metres);
    write_levels(layer, mm.values);
    return mm.clipped;
  }

  void write_levels(ImageLayer layer, const std::vector<std::uint16_t>& levels) const {
    write_png16(layer_file(picture_, layer, ".png"), images_.width, images_.height, levels);
  }

  const fs::path& picture_;
  const LayerImages& images_;
};

}  // namespace

std::vector<ImageLayer> layers_of(const std::string& list) {
  std::vector<ImageLayer> layers;
  for (std::size_t begin = 0; begin < list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::string word = list.substr(begin, end - begin);
    const auto* const found =
        std::ranges::find(kImageLayers, word, [](auto& entry) { return entry.first; });
    if (found == std::end(kImageLayers))
      throw Error(ErrorKind::usage,
                  "`layers`: " + unknown_word("layer", word, list_of<ImageLayer>(kImageLayers)));
    if (std::ranges::find(layers, found->second) == layers.end()) layers.push_back(found->second);
    begin = end + 1;
  }
  return layers;
}

std::vector<fs::path> layer_files(const fs::path& picture, const std::vector<ImageLayer>& layers) {
  std::vector<fs::path> files;
  for (const ImageLayer layer : layers) {
    files.push_back(layer_file(picture, layer, ".npy"));
    if (has_png(layer)) files.push_back(layer_file(picture, layer, ".png"));
  }
  return files;
}

std::uint64_t write_layers(const fs::path& picture, const LayerImages& images) {
  return LayerWriter(picture, images).write();
}

}  // namespace adasplats
