"use strict";
// Decodes messages by the schema that came with them, and compares this schema with the one that Foxglove publishes.

const protobuf = require("protobufjs");
const { FileDescriptorSet } = require("protobufjs/ext/descriptor");
const { foxgloveMessageSchemas, foxgloveEnumSchemas, generateProto } = require("@foxglove/schemas/internal");

const WELL_KNOWN = `syntax = "proto3"; package google.protobuf;
message Timestamp { int64 seconds = 1; int32 nanos = 2; } message Duration { int64 seconds = 1; int32 nanos = 2; }`;

function publishedTypes() {
  const root = new protobuf.Root();
  protobuf.parse(WELL_KNOWN, root, { keepCase: true });
  for (const [name, schema] of Object.entries(foxgloveMessageSchemas)) {
    if (name === "Timestamp" || name === "Duration") continue; // those of google.protobuf take their place
    const enumerations = Object.values(foxgloveEnumSchemas).filter((one) => one.parentSchemaName === name);
    protobuf.parse(generateProto(schema, enumerations), root, { keepCase: true });
  }
  root.resolveAll();
  return root;
}

const published = publishedTypes();

function compare(type, known, compared) {
  const name = type.fullName.replace(/^\./, "");
  if (compared.has(name)) return;
  compared.add(name);
  if (type instanceof protobuf.Enum) {
    if (JSON.stringify(type.values) !== JSON.stringify(known.values)) throw new Error(`${name}: other values than published`);
    return;
  }
  for (const field of type.fieldsArray) {
    const other = known.fields[field.name];
    if (!other) throw new Error(`${name}.${field.name} is not published`);
    const words = (one) => `${one.repeated ? "repeated " : ""}${one.resolvedType ? one.resolvedType.fullName : one.type} ${one.name} = ${one.id}`;
    if (words(field) !== words(other)) throw new Error(`${name}: ${words(field)}, published: ${words(other)}`);
    if (field.resolvedType) compare(field.resolvedType, other.resolvedType, compared);
  }
}

/** Returns a function that decodes messages of a schema: an encoded FileDescriptorSet. */
function decoderOf(schemaName, schemaBytes) {
  const root = protobuf.Root.fromDescriptor(FileDescriptorSet.decode(schemaBytes));
  root.resolveAll();
  const type = root.lookupType(schemaName);
  compare(type, published.lookupType(schemaName), new Set());
  return (bytes) => type.toObject(type.decode(bytes), { longs: Number, enums: String, bytes: String, defaults: true });
}

module.exports = { decoderOf };
