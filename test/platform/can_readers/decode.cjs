// What npm candied reads in a candump log by a DBC file, a line a signal: FRAME SIGNAL VALUE.
//   node decode.cjs landfix.dbc can.log
const fs = require('fs');
const { Dbc, Can } = require('candied');

const dbc = new Dbc();
const can = new Can();
can.database = dbc.load(fs.readFileSync(process.argv[2], 'utf8'));
for (const line of fs.readFileSync(process.argv[3], 'utf8').split('\n')) {
  const match = /^\([\d.]+\) \S+ ([0-9A-F]{3})#(?:#[0-9A-F])?([0-9A-F]*)$/.exec(line);
  if (!match) continue;
  const payload = match[2].match(/../g).map((byte) => parseInt(byte, 16));
  const id = parseInt(match[1], 16);
  // Not by createFrame, which knows no CAN FD; and of a message's length it reads the first digit.
  const dlc = dbc.getMessageById(id).dlc;
  const message = can.decode({ id, dlc, isExtended: false, payload });
  for (const [name, signal] of message.boundSignals) console.log(`${message.name} ${name} ${signal.value}`);
}
