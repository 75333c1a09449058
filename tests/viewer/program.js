// SPDX-License-Identifier: BSD-3-Clause
// The program shoal for tests of the page: SHOAL_PROGRAM.
import {execFile, spawn} from 'node:child_process';
import {fileURLToPath} from 'node:url';
import {promisify} from 'node:util';

export const ROOT = fileURLToPath(new URL('../..', import.meta.url));
const PROGRAM = process.env.SHOAL_PROGRAM;

/** Runs shoal to its end; returns what it printed. */
export async function shoal(...words) {
  const {stdout} = await promisify(execFile)(PROGRAM, words, {cwd: ROOT, maxBuffer: 1 << 24});
  return stdout;
}

/** Starts `shoal run --view` or `shoal view`; returns {url, end()}. */
export async function serve(...words) {
  const child = spawn(PROGRAM, words, {cwd: ROOT, stdio: ['ignore', 'pipe', 'pipe']});
  const ended = new Promise((done) => child.once('close', done));
  const url = await new Promise((done, failed) => {
    let output = '';
    const receive = (data) => {
      output += data;
      const found = /live page: (http:\S+)\s/.exec(output);
      if (found) done(found[1]);
    };
    child.stdout.on('data', receive);
    child.stderr.on('data', receive);
    ended.then((code) => failed(new Error(`shoal ${words.join(' ')}: exit code ${code}: ${output}`)));
  });
  return {
    url,
    end: async () => {
      child.kill('SIGINT');
      await ended;
    }
  };
}
