// SPDX-License-Identifier: GPL-3.0-or-later
#include <mutex>

#include "common.hpp"
#include "sparse_mocap/streams/drivers.hpp"

namespace sparse_mocap::python {
namespace {

using namespace streams;

ByteView view_of(const py::bytes& data) {
  const auto text = static_cast<std::string_view>(data);
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

py::bytes bytes_of(const Bytes& data) {
  return {reinterpret_cast<const char*>(data.data()), data.size()};
}

py::list list_of(const std::vector<Bytes>& packets) {
  py::list list;
  for (const auto& packet : packets) list.append(bytes_of(packet));
  return list;
}

std::string option_text(const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  if (py::isinstance<py::str>(value) || py::isinstance<py::int_>(value) ||
      py::isinstance<py::float_>(value))
    return py::str(value).cast<std::string>();
  std::string joined;
  for (const auto& item : value)
    joined += (joined.empty() ? "" : ",") + py::str(item).cast<std::string>();
  return joined;
}

OptionMap options_of(const py::kwargs& given) {
  OptionMap options;
  for (const auto& [name, value] : given)
    options[py::str(name).cast<std::string>()] = option_text(value);
  return options;
}

template <typename T, typename Get>
py::array_t<T> column_of(const std::vector<Sample>& samples, const Get& get) {
  py::array_t<T> column(static_cast<py::ssize_t>(samples.size()));
  std::transform(samples.begin(), samples.end(), column.mutable_data(), get);
  return column;
}

template <typename Get>
py::array_t<double> rows_of(const std::vector<Sample>& samples, py::ssize_t width, const Get& get) {
  auto rows = new_array({static_cast<py::ssize_t>(samples.size()), width});
  double* out = rows.mutable_data();
  for (const auto& sample : samples) {
    const auto& value = get(sample);
    out = std::copy(value.data(), value.data() + value.size(), out);
  }
  return rows;
}

py::dict arrays_of(const std::vector<Sample>& samples) {
  py::dict out;
  out["sensor"] = column_of<std::int64_t>(samples, [](const Sample& s) { return s.sensor; });
  out["time_s"] = column_of<double>(samples, [](const Sample& s) { return s.time_s; });
  out["counter"] = column_of<std::int64_t>(samples, [](const Sample& s) { return s.counter; });
  out["specific_force"] = rows_of(
      samples, 3, [](const Sample& s) -> const auto& { return s.specific_force; });
  out["angular_velocity"] = rows_of(
      samples, 3, [](const Sample& s) -> const auto& { return s.angular_velocity; });
  out["orientation"] = rows_of(
      samples, 4, [](const Sample& s) -> const auto& { return s.orientation; });
  out["magnetic_field"] = rows_of(
      samples, 3, [](const Sample& s) -> const auto& { return s.magnetic_field; });
  out["flags"] = column_of<std::uint32_t>(samples, [](const Sample& s) { return s.flags; });
  return out;
}

// A parser that threads may share.
class SharedParser {
 public:
  explicit SharedParser(std::unique_ptr<StreamParser> parser) : parser_(std::move(parser)) {}

  py::dict feed(const py::bytes& data, const std::optional<std::string>& sender) {
    std::vector<Sample> samples;
    const auto bytes = view_of(data);
    with_parser([&](StreamParser& parser) {
      if (sender)
        parser.feed_datagram(bytes, *sender, samples);
      else
        parser.feed(bytes, samples);
    });
    return arrays_of(samples);
  }

  // Runs without the GIL.
  template <typename Do>
  void with_parser(const Do& run) {
    const py::gil_scoped_release release;
    const std::lock_guard lock(mutex_);
    run(*parser_);
  }

 private:
  std::mutex mutex_;
  std::unique_ptr<StreamParser> parser_;
};

std::map<std::string, std::uint64_t> counters_of(SharedParser& shared) {
  std::map<std::string, std::uint64_t> counters;
  shared.with_parser([&](StreamParser& parser) {
    for (std::size_t i = 0; i < kNumCounts; ++i) {
      const auto what = static_cast<Count>(i);
      counters[std::string(count_name(what))] = parser.counters()[what];
    }
  });
  return counters;
}

template <typename Get>
auto asked(SharedParser& shared, const Get& get) {
  std::decay_t<decltype(get(std::declval<StreamParser&>()))> value;
  shared.with_parser([&](StreamParser& parser) { value = get(parser); });
  return value;
}

void set_row(double* out, const std::optional<Doubles>& rows, std::size_t at, py::ssize_t width) {
  if (rows) std::copy_n(rows->data(static_cast<py::ssize_t>(at), 0), width, out);
}

py::list encode(StreamEncoder& encoder, double time_s, std::int64_t counter,
                const Doubles& specific_force, const std::optional<Doubles>& angular_velocity,
                const std::optional<Doubles>& orientation,
                const std::optional<std::vector<int>>& sensors) {
  require_shape(specific_force, {-1, 3}, "specific_force");
  const auto num = specific_force.shape(0);
  if (angular_velocity) require_shape(*angular_velocity, {num, 3}, "angular_velocity");
  if (orientation) require_shape(*orientation, {num, 4}, "orientation");
  if (sensors && sensors->size() != static_cast<std::size_t>(num))
    throw py::value_error("sensors must have one index for each row");
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < static_cast<std::size_t>(num); ++i) {
    Sample sample;
    sample.sensor = sensors ? (*sensors)[i] : static_cast<int>(i);
    sample.time_s = time_s;
    sample.counter = counter;
    set_row(sample.specific_force.data(), specific_force, i, 3);
    set_row(sample.angular_velocity.data(), angular_velocity, i, 3);
    set_row(sample.orientation.data(), orientation, i, 4);
    samples.push_back(sample);
  }
  return list_of(encoder.encode(samples));
}

void bind_parser(py::module_& m) {
  using Shared = SharedParser;
  py::class_<Shared>(
      m, "StreamParser",
      R"doc(Turns a device's bytes into samples; options are those of driver_options. Thread-safe.

Raises ConfigError for an unknown driver or option, naming the nearest, and for wrong values.)doc")
      .def(py::init([](const std::string& driver, const py::kwargs& options) {
             return std::make_unique<Shared>(make_parser(driver, options_of(options)));
           }),
           py::arg("driver"))
      .def(
          "feed", &Shared::feed, py::arg("data"), py::arg("sender") = py::none(),
          R"doc(The samples (N) that the bytes complete, however they are cut; NaN for what is absent.

``sensor`` (N,) index into sensor_names; ``time_s`` (N,) the device's clock, unwrapped;
``counter`` (N,) unwrapped, -1 for none; ``specific_force`` (N, 3) m/s^2;
``angular_velocity`` (N, 3) rad/s; ``orientation`` (N, 4) R_world_sensor, world y up;
``magnetic_field`` (N, 3) in the device's unit; ``flags`` (N,) of SAMPLE_FLAGS.
With a sender the data are one datagram.)doc")
      .def(
          "reset", [](Shared& shared) { shared.with_parser([](auto& p) { p.reset(); }); },
          "The connection was reopened: sensors keep their indices, counters continue.")
      .def(
          "begin_message",
          [](Shared& shared) { shared.with_parser([](auto& p) { p.begin_message(); }); },
          "After reset: the line was idle for so long that the next byte begins a message.")
      .def(
          "interrupt", [](Shared& shared) { shared.with_parser([](auto& p) { p.interrupt(); }); },
          "Bytes are missing before the next ones: an incomplete message is dropped.")
      .def(
          "pop_replies",
          [](Shared& shared) {
            return list_of(asked(shared, [](auto& p) { return p.pop_replies(); }));
          },
          "The answers that the protocol expects, each once.")
      .def_property_readonly("counters", &counters_of,
                             "What was received and what was lost, each kind by its name.")
      .def_property_readonly(
          "sensor_names",
          [](Shared& shared) { return asked(shared, [](auto& p) { return p.sensor_names(); }); },
          "The sensors seen so far, in the order of their indices.")
      .def_property_readonly(
          "sensor_ids",
          [](Shared& shared) { return asked(shared, [](auto& p) { return p.sensor_ids(); }); },
          "What each device calls itself wherever it is plugged in; empty without such.")
      .def_property_readonly(
          "sensor_batteries",
          [](Shared& shared) {
            return asked(shared, [](auto& p) { return p.sensor_batteries(); });
          },
          "How full each battery is, in percent; NaN while it is not known.")
      .def_property_readonly(
          "last_message",
          [](Shared& shared) { return asked(shared, [](auto& p) { return p.last_message(); }); },
          "The last text from the device, such as an error.");
}

void bind_encoder(py::module_& m) {
  py::class_<StreamEncoder>(m, "StreamEncoder", "What a device with these sensors would send.")
      .def(py::init([](const std::string& driver, const std::vector<std::string>& sensor_names,
                       const py::kwargs& options) {
             return make_encoder(driver, options_of(options), sensor_names);
           }),
           py::arg("driver"), py::arg("sensor_names"))
      .def(
          "hello", [](StreamEncoder& encoder) { return list_of(encoder.hello()); },
          "What the device sends when it starts.")
      .def("encode", &encode, py::arg("time_s"), py::arg("counter"), py::arg("specific_force"),
           py::arg("angular_velocity") = py::none(), py::arg("orientation") = py::none(),
           py::arg("sensors") = py::none(),
           R"doc(The packets of one instant: (S, 3) m/s^2, (S, 3) rad/s, (S, 4) R_world_sensor.

sensors: whose rows these are; all sensors' when None.)doc")
      .def(
          "respond",
          [](StreamEncoder& encoder, const py::bytes& from_host) {
            return bytes_of(encoder.respond(view_of(from_host)));
          },
          py::arg("from_host"), "What the device answers to what a host sends it.");
}

void bind_drivers(py::module_& m) {
  m.def("driver_names", &driver_names, "The protocols that StreamParser takes.");
  m.def(
      "driver_options",
      [](const std::string& driver) {
        std::map<std::string, std::pair<std::string, std::string>> options;
        for (const auto& spec : driver_options(driver))
          options[spec.name] = {spec.default_value, spec.description};
        return options;
      },
      py::arg("driver"), "Each option's default and what it means.");
  m.def(
      "start_commands",
      [](const std::string& driver, const py::kwargs& options) {
        return list_of(start_commands(driver, options_of(options)));
      },
      py::arg("driver"), "What makes the device stream, to be sent one after the other.");
  m.def(
      "keep_alive_commands",
      [](const std::string& driver, const py::kwargs& options) {
        return list_of(keep_alive_commands(driver, options_of(options)));
      },
      py::arg("driver"), "What must be sent every second to keep the device streaming.");
}

}  // namespace

void bind_streams(py::module_& m) {
  bind_parser(m);
  bind_encoder(m);
  bind_drivers(m);
  py::dict flags;
  flags["clipped"] = static_cast<int>(kClipped);
  flags["after_gap"] = static_cast<int>(kAfterGap);
  flags["after_reset"] = static_cast<int>(kAfterReset);
  flags["gravity_restored"] = static_cast<int>(kGravityRestored);
  m.attr("SAMPLE_FLAGS") = flags;
}

}  // namespace sparse_mocap::python
