// Motion of one machine on its page, without a browser. The argument is a job as JSON; the answer is written as JSON.
import { readFileSync } from "node:fs";

const job = JSON.parse(readFileSync(process.argv[2], "utf8"));
console.log(JSON.stringify({ missing: `page: no driver for ${job.page}` }));
