/** The program itself, started by tests of the page. */
import { spawn, type ChildProcess } from "node:child_process";
import { existsSync } from "node:fs";
import { fileURLToPath } from "node:url";

/** The program that was built, or the one that VANTAGE names. */
export const PROGRAM = process.env["VANTAGE"] ?? fileURLToPath(new URL("../../build/release/vantage", import.meta.url));

export class Program {
  /** What it said on standard error. */
  text = "";
  /** Its exit code. */
  readonly ended: Promise<number | null>;

  private constructor(private readonly child: ChildProcess) {
    this.ended = new Promise((done) => child.on("exit", (code) => done(code)));
    child.stdout!.resume();
  }

  static start(...words: string[]): Program {
    if (!existsSync(PROGRAM)) throw new Error(`${PROGRAM} is missing: build the program or set VANTAGE`);
    return new Program(spawn(PROGRAM, words, { stdio: ["ignore", "pipe", "pipe"] }));
  }

  /** The address of the page, as soon as the program says it. */
  url(): Promise<string> {
    return new Promise((done, fail) => {
      this.child.stderr!.on("data", (piece) => {
        this.text += String(piece);
        const found = /the page is at (http\S+)/.exec(this.text);
        if (found) done(found[1]);
      });
      void this.ended.then((code) => fail(new Error(`ended with ${code}: ${this.text}`)));
    });
  }

  /** Presses Ctrl-C and gives the exit code. */
  interrupt(): Promise<number | null> {
    this.child.kill("SIGINT");
    return this.ended;
  }
}
