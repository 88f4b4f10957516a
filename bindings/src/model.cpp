// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/model.hpp"

#include <array>
#include <memory>
#include <stdexcept>

#include "common.hpp"
#include "sparse_mocap/database/model_file.hpp"

namespace sparse_mocap::python {
namespace {

namespace fs = std::filesystem;
using Texts = std::map<std::string, std::string>;

struct NumpyType {
  ElementType type;
  const char* name;  // NumPy's
};

constexpr std::array kNumpyTypes{
    NumpyType{ElementType::boolean, "bool"}, NumpyType{ElementType::u8, "uint8"},
    NumpyType{ElementType::i8, "int8"},      NumpyType{ElementType::u16, "uint16"},
    NumpyType{ElementType::i16, "int16"},    NumpyType{ElementType::f16, "float16"},
    NumpyType{ElementType::u32, "uint32"},   NumpyType{ElementType::i32, "int32"},
    NumpyType{ElementType::f32, "float32"},  NumpyType{ElementType::u64, "uint64"},
    NumpyType{ElementType::i64, "int64"},    NumpyType{ElementType::f64, "float64"},
    NumpyType{ElementType::c64, "complex64"}};

py::dtype dtype_of(const std::string& name, ElementType type) {
  for (const auto& known : kNumpyTypes)
    if (known.type == type) return py::dtype(known.name);
  throw py::value_error("NumPy has no type for the elements " + std::string(name_of(type)) +
                        " of the tensor '" + name + "'");
}

ElementType element_type_of(const std::string& name, const py::array& values) {
  for (const auto& known : kNumpyTypes)
    if (values.dtype().equal(py::dtype(known.name))) return known.type;
  throw py::value_error("the tensor '" + name + "' has the type " +
                        py::str(values.dtype()).cast<std::string>() +
                        ", which a model cannot hold; convert it with astype");
}

ModelTensor tensor_from(const std::string& name, const py::handle& values) {
  const auto array = py::array::ensure(values, py::array::c_style);
  if (!array) throw py::error_already_set();
  ModelTensor tensor{element_type_of(name, array), {}, {}};
  for (py::ssize_t i = 0; i < array.ndim(); ++i)
    tensor.shape.push_back(static_cast<std::size_t>(array.shape(i)));
  const auto* begin = static_cast<const std::byte*>(array.data());
  tensor.bytes.assign(begin, begin + array.nbytes());
  return tensor;
}

std::shared_ptr<Model> make_model(const std::string& method,
                                  const std::map<std::string, py::object>& tensors,
                                  const Texts& metadata, int version) {
  auto model = std::make_shared<Model>();
  model->method = method;
  model->version = version;
  model->metadata = metadata;
  for (const auto& [name, values] : tensors)
    model->tensors.emplace(name, tensor_from(name, values));
  check_model(*model);
  return model;
}

// A read-only view that keeps the model alive.
py::array view_of(const std::shared_ptr<Model>& model, const std::string& name) {
  const auto at = model->tensors.find(name);
  if (at == model->tensors.end())
    throw py::key_error("the model of '" + model->method + "' has no tensor '" + name + "'");
  const ModelTensor& tensor = at->second;
  const std::vector<py::ssize_t> shape(tensor.shape.begin(), tensor.shape.end());
  py::array view(dtype_of(name, tensor.type), shape, tensor.bytes.data(), py::cast(model));
  view.attr("setflags")(py::arg("write") = false);
  return view;
}

std::vector<std::string> names_of(const Model& model) {
  std::vector<std::string> names;
  for (const auto& [name, tensor] : model.tensors) names.push_back(name);
  return names;
}

py::dict views_of(const std::shared_ptr<Model>& model) {
  py::dict views;
  for (const auto& name : names_of(*model)) views[py::str(name)] = view_of(model, name);
  return views;
}

// Name, element type as safetensors calls it, shape, size in bytes.
py::list described(const Model& model) {
  py::list rows;
  for (const auto& [name, tensor] : model.tensors)
    rows.append(py::make_tuple(name, name_of(tensor.type), py::tuple(py::cast(tensor.shape)),
                               tensor.bytes.size()));
  return rows;
}

}  // namespace

void bind_model(py::module_& m) {
  using release = py::call_guard<py::gil_scoped_release>;
  py::class_<Model, std::shared_ptr<Model>>(
      m, "Model",
      R"doc(What a method has learned: named tensors, and texts that say how it came about. Immutable.

method is a name of a-z, 0-9 and _; version, from 1 on, is of what the method keeps in its
models; path is the file that it was read from.)doc")
      .def(
          py::init(&make_model), py::arg("method"),
          py::arg("tensors") = std::map<std::string, py::object>(), py::kw_only(),
          py::arg("metadata") = Texts(), py::arg("version") = 1,
          R"doc(Copies the tensors: of any shape, finite, types as NumPy's numbers of up to 8 bytes.

Raises ValueError.)doc")
      .def_readonly("method", &Model::method, "Whose model it is, see method_names.")
      .def_readonly("version", &Model::version, "Of what the method keeps in its models.")
      .def_readonly("metadata", &Model::metadata, "The method's own texts.")
      .def_property_readonly(
          "path", [](const Model& model) { return model.path.string(); },
          "The file that it was read from, or empty.")
      .def_property_readonly(
          "tensors", &views_of,
          "Read-only views by name. Raises ValueError for types that NumPy lacks (BF16, F8).")
      .def_property_readonly(
          "tensor_infos", &described,
          "Name, element type as safetensors calls it, shape and bytes of each tensor.")
      .def("tensor", &view_of, py::arg("name"),
           "A read-only view. Raises KeyError, and ValueError for types that NumPy lacks.");
  m.def(
      "read_model", [](const fs::path& path) { return std::make_shared<Model>(read_model(path)); },
      py::arg("path"), release(),
      "The model in an .smmodel, checked as a whole. Raises FormatError.");
  m.def("write_model", &write_model, py::arg("path"), py::arg("model"), release(),
        "Writes an .smmodel atomically. Raises OSError.");
  m.def("store_model", &store_model, py::arg("database"), py::arg("model"), release(),
        R"doc(Puts a model into a motion database, in place of the same method's; all else stays.

The file is replaced atomically. Raises FormatError and OSError.)doc");
  m.def("remove_model", &remove_model, py::arg("database"), py::arg("method"), release(),
        "Takes a method's model out of a motion database. Raises FormatError and OSError.");
}

}  // namespace sparse_mocap::python
