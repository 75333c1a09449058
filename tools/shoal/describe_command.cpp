#include <iostream>
#include <memory>

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
      command->add_option("NAME", *name, "a device type, a message type, device, noise, world or vehicle");
  CLI::Option* page_option = command->add_option("--page", *page, "print a whole page of docs/ in Markdown")
                                 ->check(CLI::IsMember({"devices", "messages", "world_format"}));
  CLI::Option* schema_option = command->add_option("--schema", *schema, "print the JSON Schema of a file's keys")
                                   ->check(CLI::IsMember({"world", "vehicle"}));
  name_option->excludes(page_option)->excludes(schema_option);
  page_option->excludes(schema_option);
  add_plugin_option(*command);
  command->footer(
      "Examples:\n  shoal describe lidar\n  shoal describe world\n  shoal describe pose_t\n"
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

}  // namespace tools
