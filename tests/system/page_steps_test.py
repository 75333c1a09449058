# SPDX-License-Identifier: BSD-3-Clause
"""page_steps.py, on small pages."""
import unittest

from page_steps import Change, Commands, File, PageError, commands_outside_blocks, missing_lines, steps_of


class Steps(unittest.TestCase):
    def test_a_file_is_named_by_the_paragraph_before_it(self):
        self.assertEqual(steps_of("Write\n`a.yaml`:\n\n```yaml\nname: a\n```\n"), [File(4, "a.yaml", "name: a\n")])

    def test_a_file_without_a_name_is_an_error(self):
        with self.assertRaisesRegex(PageError, "line 3: the paragraph before a file ends with its name"):
            steps_of("Write this:\n\n```yaml\nname: a\n```\n")

    def test_commands_are_lines_without_comments_and_joined_by_backslashes(self):
        page = "Run:\n\n```sh\n# first\nshoal run a \\\n    --speed max  # quickly\n\nshoal list\n```\n"
        self.assertEqual(steps_of(page)[0].commands, ["shoal run a --speed max  # quickly", "shoal list"])

    def test_output_belongs_to_the_commands_before_it(self):
        step, = steps_of("Run:\n\n```sh\nls\n```\n\n```text\na\n\nb ... c\n```\n")
        self.assertEqual(step, Commands(3, ["ls"], printed=["a", "b ... c"]))

    def test_the_exit_code_and_the_terminal_are_in_the_paragraph(self):
        page = "Run:\n\n```sh\nsleep 9\n```\n\nIn a second terminal, with exit\ncode 2:\n\n```sh\nls\n```\n\n" \
               "In the first terminal:\n\n```text\ndone\n```\n"
        first, second = steps_of(page)
        self.assertEqual((first.exit_code, first.second_terminal), (0, False))
        self.assertEqual((second.exit_code, second.second_terminal), (2, True))
        self.assertEqual((second.printed, second.printed_beside), ([], ["done"]))

    def test_a_change_replaces_lines_that_are_there_once(self):
        change, = steps_of("In `a.yaml`, change a line:\n\n```diff\n name: a\n-speed: 1\n+speed: max\n```\n")
        self.assertEqual(change.applied("name: a\nspeed: 1\nseed: 1\n"), "name: a\nspeed: max\nseed: 1\n")
        with self.assertRaisesRegex(PageError, "line 3: the lines to change are 0 times in a.yaml"):
            change.applied("name: a\nspeed: 2\n")
        with self.assertRaisesRegex(PageError, "are 2 times"):
            change.applied("name: a\nspeed: 1\n" * 2)

    def test_a_change_of_no_file_is_an_error(self):
        with self.assertRaisesRegex(PageError, "which file"):
            steps_of("Change it:\n\n```diff\n-a\n```\n")

    def test_commands_in_sentences_that_are_in_no_block_are_found(self):
        page = "Use `shoal spy`, `shoal run b`, or `shoal run a --speed\nmax`.\n\n```sh\nshoal run b --seed 1\n```\n"
        self.assertEqual(commands_outside_blocks(page, ("shoal ",)), ["shoal run a --speed max"])


class Output(unittest.TestCase):
    def test_dots_are_any_text_and_spaces_count_as_one(self):
        self.assertEqual(missing_lines(["a ... d", "x  y"], "a b c d\nx y\n"), [])

    def test_a_line_that_is_not_there_is_named(self):
        self.assertEqual(missing_lines(["a", "b"], "a\nabc\n"), ["b"])

    def test_what_a_terminal_overwrites_counts_as_lines(self):
        self.assertEqual(missing_lines(["b"], "a\r\x1b[Kb\n"), [])


if __name__ == "__main__":
    unittest.main()
