// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "pickles.h"

namespace adasplats::python {

void wrong_pickle(const std::string& type, const std::string& what) {
  throw py::value_error("the pickle of an " + type + " " + what +
                        "; use save() for data that is kept longer");
}

py::dict fields_of_pickle(const std::string& type, const py::object& pickle) {
  if (!py::isinstance<py::tuple>(pickle) || py::len(pickle) != 3) wrong_pickle(type, "is damaged");
  const auto parts = py::reinterpret_borrow<py::tuple>(pickle);
  const std::string found = py::str(parts[0]);
  if (found != type) wrong_pickle(type, "is of " + found);
  const std::string version = py::str(parts[1]);
  if (version != std::to_string(kPickleVersion))
    wrong_pickle(type, "has version " + version + ", this adasplats (" + ADASPLATS_VERSION +
                           ") reads version " + std::to_string(kPickleVersion));
  if (!py::isinstance<py::dict>(parts[2])) wrong_pickle(type, "is damaged");
  return py::reinterpret_borrow<py::dict>(parts[2]);
}

}  // namespace adasplats::python
