// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <filesystem>

#include "adasplats/core/error.h"
#include "bindings.h"
#include "keywords.h"

namespace adasplats::python {
namespace {

/// The Python class of each kind; never freed, like modules.
std::array<PyObject*, 8> classes_of_kinds{};

PyObject*& class_of(ErrorKind kind) { return classes_of_kinds[static_cast<std::size_t>(kind)]; }

/// A class derived from adasplats.Error and a built-in exception.
PyObject* make_class(py::module_& module, const char* name, const char* doc, const py::object& ours,
                     PyObject* theirs) {
  const py::tuple bases = py::make_tuple(ours, py::handle(theirs));
  PyObject* made = PyErr_NewExceptionWithDoc((std::string("adasplats.") + name).c_str(), doc,
                                             bases.ptr(), nullptr);
  if (made == nullptr) throw py::error_already_set();
  module.attr(name) = py::handle(made);
  return made;
}

}  // namespace

void bind_errors(py::module_& module) {
  const auto base = py::reinterpret_steal<py::object>(PyErr_NewExceptionWithDoc(
      "adasplats.Error",
      "Base of all errors of adasplats; each also derives from a built-in exception.",
      PyExc_Exception, nullptr));
  module.attr("Error") = base;
  class_of(ErrorKind::usage) =
      make_class(module, "UsageError", "Arguments are wrong or contradict each other.", base,
                 PyExc_ValueError);
  class_of(ErrorKind::data) =
      make_class(module, "DataError", "The content of an input is wrong.", base, PyExc_ValueError);
  class_of(ErrorKind::config) =
      make_class(module, "ConfigError", "A configuration file is wrong.", base, PyExc_ValueError);
  class_of(ErrorKind::no_input) =
      make_class(module, "InputError", "An input is missing or cannot be opened.", base,
                 PyExc_FileNotFoundError);
  class_of(ErrorKind::io) = class_of(ErrorKind::cannot_create) =
      make_class(module, "OutputError",
                 "Reading or writing failed, or an output cannot be created.", base, PyExc_OSError);
  class_of(ErrorKind::unavailable) = make_class(
      module, "UnavailableError", "A GPU, a program or a library is missing on this machine.", base,
      PyExc_RuntimeError);
  class_of(ErrorKind::software) =
      make_class(module, "SoftwareError", "A bug in adasplats.", base, PyExc_RuntimeError);
  // NOLINTNEXTLINE(performance-unnecessary-value-param): signature required by pybind11
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& error) {
      PyErr_SetString(class_of(error.kind()), with_keywords(error.what()).c_str());
    } catch (const std::filesystem::filesystem_error& error) {
      PyErr_SetString(class_of(ErrorKind::cannot_create), error.what());
    }
  });
}

}  // namespace adasplats::python
