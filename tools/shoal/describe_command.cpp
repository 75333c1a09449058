#include <iostream>
#include <memory>

#include "shoal/message_schema.hpp"
#include "sim/device/device_registry.hpp"
#include "tools/shoal/commands.hpp"
#include "tools/shoal/json_schema.hpp"
#include "tools/shoal/reference_pages.hpp"

namespace tools {

void add_describe_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("describe", "Say what a device, a message or a file's keys are");
  const auto name = std::make_shared<std::string>();
  const auto page = std::make_shared<std::string>();
  const auto schema = std::make_shared<std::string>();
  CLI::Option* name_option =
      command->add_option("NAME", *name, "a device type, a message type, device, noise, world, vehicle or metrics");
  CLI::Option* page_option = command->add_option("--page", *page, "print a whole page of docs/ in Markdown")
                                 ->check(CLI::IsMember({"devices", "messages", "metrics", "world_format"}));
  CLI::Option* schema_option = command->add_option("--schema", *schema, "print the JSON Schema of a file's keys")
                                   ->check(CLI::IsMember({"world", "vehicle"}));
  name_option->excludes(page_option)->excludes(schema_option);
  page_option->excludes(schema_option);
  add_plugin_option(*command);
  command->footer(
      "Examples:\n  shoal describe lidar\n  shoal describe world\n  shoal describe metrics\n  shoal describe pose_t\n"
      "  shoal describe --schema world > world.schema.json\n"
      "  shoal describe thermometer --plugin build/thermometer.so");
  command->callback([name, page, schema, &exit_code] {
    if (!page->empty() || !schema->empty()) {
      std::cout << (page->empty() ? json_schema(*schema) : reference_page(*page));
      return;
    }
    const std::string text = describe_text(*name);
    if (text.empty()) {
      std::cerr << "shoal describe: nothing is called '" << *name
                << "'; see `shoal list devices` and `shoal list messages`\n";
      exit_code = exit_usage;
    }
    std::cout << text;
  });
}

namespace {

void list(const std::string& what) {
  if (what == "devices")
    for (const sim::DeviceType* type : sim::DeviceRegistry::instance().all())
      std::cout << type->name << std::string(20 - std::min<std::size_t>(19, type->name.size()), ' ') << type->meaning
                << '\n';
  if (what == "messages")
    for (const auto& [name, schema] : shoal::embedded_types().all()) {
      char fingerprint[20];
      std::snprintf(fingerprint, sizeof fingerprint, "%016llx", static_cast<unsigned long long>(schema.fingerprint));
      std::cout << fingerprint << "  " << name << '\n';
    }
}

}  // namespace

void add_list_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("list", "List device types or message types");
  const auto what = std::make_shared<std::string>();
  command->add_option("WHAT", *what, "devices or messages")->required()->check(CLI::IsMember({"devices", "messages"}));
  add_plugin_option(*command);
  command->footer("Example:\n  shoal list devices");
  command->callback([what, &exit_code] {
    list(*what);
    exit_code = exit_ok;
  });
}

}  // namespace tools
