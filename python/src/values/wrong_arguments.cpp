// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Errors for arguments that fit no overload: pybind11's own text lists C++ types. Every function is
// wrapped in one that calls it and replaces such a text by one in terms of the Python signature.

#include <algorithm>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "arrays.h"
#include "bindings.h"

namespace adasplats::python {
namespace {

struct Parameter {
  std::string name;
  bool is_keyword_only = false;
  bool has_default = false;
};

struct Signature {
  std::string function;
  std::string text;  ///< "(name, *, other=None)", without self
  std::vector<Parameter> parameters;
  bool takes_any_keyword = false;
};

/// The parts of "a, b=(1, 2), *, c='x'" between the commas that separate parameters.
std::vector<std::string> parts_of(const std::string& inner) {
  std::vector<std::string> parts(1);
  int depth = 0;
  bool is_quoted = false;
  for (const char c : inner) {
    if (c == '\'') is_quoted = !is_quoted;
    if (!is_quoted) depth += (c == '(' || c == '[') - (c == ')' || c == ']');
    if (c == ',' && depth == 0 && !is_quoted) {
      parts.emplace_back();
    } else if (c != ' ' || !parts.back().empty()) {
      parts.back() += c;
    }
  }
  return parts;
}

/// The parsed first line of a docstring; `text` as in __text_signature__: "($self, name, *,
/// other=1)".
Signature signature_of(const std::string& function, const std::string& text) {
  Signature signature;
  signature.function = function;
  bool is_keyword_only = false;
  for (const std::string& part : parts_of(text.substr(1, text.size() - 2))) {
    if (part.empty() || part == "$self" || part == "self" || part == "/") continue;
    signature.text += (signature.text.empty() ? "(" : ", ") + part;
    if (part.starts_with("**")) {
      signature.takes_any_keyword = true;
    } else if (part == "*") {
      is_keyword_only = true;
    } else {
      const std::size_t equals = part.find('=');
      signature.parameters.push_back(
          {part.substr(0, equals), is_keyword_only, equals != std::string::npos});
    }
  }
  signature.text += signature.text.empty() ? "()" : ")";
  return signature;
}

/// The error of arguments that no overload accepts; `given` without self.
std::string fault_of(const Signature& signature, const std::vector<py::handle>& given,
                     const py::kwargs& keywords) {
  std::vector<std::string> names;
  for (const Parameter& parameter : signature.parameters) names.push_back(parameter.name);
  for (const auto& [key, value] : keywords) {
    const std::string name = py::str(key);
    if (signature.takes_any_keyword || std::ranges::find(names, name) != names.end()) continue;
    return " got an unexpected keyword argument '" + name + "'" + did_you_mean(name, names);
  }
  const auto positional = static_cast<std::size_t>(
      std::ranges::count(signature.parameters, false, &Parameter::is_keyword_only));
  if (given.size() > positional)
    return " takes at most " + std::to_string(positional) + " positional arguments, but " +
           std::to_string(given.size()) + " were given";
  for (std::size_t i = 0; i < signature.parameters.size(); ++i) {
    const Parameter& parameter = signature.parameters[i];
    const bool is_named = keywords.contains(parameter.name);
    if (i < given.size() && is_named)
      return " got several values for the argument '" + parameter.name + "'";
    if (i >= given.size() && !is_named && !parameter.has_default)
      return " is missing the argument '" + parameter.name + "'";
  }
  std::string types;
  for (const py::handle value : given) types += (types.empty() ? "" : ", ") + type_name(value);
  for (const auto& [key, value] : keywords)
    types += (types.empty() ? "" : ", ") + std::string(py::str(key)) + ": " + type_name(value);
  return signature.text + " does not take (" + types + ")";
}

/// Whether pybind11 found no overload for the arguments.
bool is_overload_error(const py::error_already_set& error) {
  if (!error.matches(PyExc_TypeError)) return false;
  const std::string text = py::str(error.value());
  return text.find("incompatible ") != std::string::npos &&
         text.find("The following argument types are supported") != std::string::npos;
}

py::object called(const py::object& original, const Signature& signature, bool has_self,
                  const py::args& args, const py::kwargs& kwargs) {
  try {
    return original(*args, **kwargs);
  } catch (const py::error_already_set& error) {
    if (!is_overload_error(error)) throw;
  }
  std::vector<py::handle> given;
  for (std::size_t i = has_self ? 1 : 0; i < args.size(); ++i) given.emplace_back(args[i]);
  const std::string fault = fault_of(signature, given, kwargs);
  throw py::type_error(signature.function + (fault.starts_with('(') ? "" : "()") + fault);
}

enum class Kind : std::uint8_t { function, method, static_method };

/// Replaces owner.name, which is `original`, by its wrapper. Functions without a signature in their
/// docstring are left alone.
void wrap(const py::object& owner, const std::string& name, const py::object& original, Kind kind) {
  const py::object text = py::getattr(original, "__text_signature__", py::none());
  if (text.is_none()) return;
  // A constructor gets the name of its class: pybind11 treats functions named __init__ specially.
  const std::string shown =
      name == "__init__" ? std::string(py::str(owner.attr("__name__"))) : name;
  const std::string signature = py::str(text);
  const std::string doc =
      shown + signature + "\n--\n\n" + std::string(py::str(original.attr("__doc__")));
  const bool is_method = kind == Kind::method;
  const auto call = [original, is_method, parsed = signature_of(shown, signature)](
                        const py::args& args, const py::kwargs& kwargs) {
    return called(original, parsed, is_method, args, kwargs);
  };
  if (is_method) {
    owner.attr(name.c_str()) =
        py::cpp_function(call, py::name(shown.c_str()), py::is_method(owner), doc.c_str());
    return;
  }
  const py::cpp_function function(call, py::name(shown.c_str()), py::scope(owner), doc.c_str());
  owner.attr(name.c_str()) =
      kind == Kind::static_method ? py::object(py::staticmethod(function)) : py::object(function);
}

void wrap_members(const py::object& type) {
  for (const auto& [key, value] : py::dict(type.attr("__dict__"))) {
    const std::string name = py::str(key);
    if (name.starts_with('_') && name != "__init__") continue;
    if (PyInstanceMethod_Check(value.ptr()) == 1) {
      wrap(type, name, type.attr(name.c_str()), Kind::method);
    } else if (PyObject_TypeCheck(value.ptr(), &PyStaticMethod_Type) != 0) {
      wrap(type, name, type.attr(name.c_str()), Kind::static_method);
    }
  }
}

}  // namespace

void explain_wrong_arguments(const py::module_& module) {
  for (const auto& [key, value] : py::dict(module.attr("__dict__"))) {
    if (PyType_Check(value.ptr()) == 1) {
      wrap_members(py::reinterpret_borrow<py::object>(value));
    } else if (PyModule_Check(value.ptr()) == 1) {
      explain_wrong_arguments(py::reinterpret_borrow<py::module_>(value));
    } else if (PyCFunction_Check(value.ptr()) == 1) {
      wrap(module, py::str(key), py::reinterpret_borrow<py::object>(value), Kind::function);
    }
  }
}

}  // namespace adasplats::python
