//! The templates of the releases before templates had name spaces, by which older fields are written without a prefix.
//!
//! Owns their bodies, which are our own: names and parameters are those of the original, so that fields written for it are
//! read here. A robot that stands is one whose `isRiding` is false.

/// The library, in the form in which an author writes templates.
pub(super) const FORMER: &str = r##"<templates>
<template name="condition-event">
  <params>
    <param name="id"/>
    <param name="settedUpInit" default="true"/>
    <param name="conditions"><true/></param>
    <param name="trigger"><success/></param>
  </params>
  <content><![CDATA[
    <event id="#{id}" settedUpInitially="#{settedUpInit}">
      <conditions glue="and"><condition><true/></condition>#{conditions}</conditions>
      <triggers>#{trigger}</triggers>
    </event>
  ]]></content>
</template>
<template name="timer-success-event">
  <params>
    <param name="timeout"/>
    <param name="trigger" default=""/>
  </params>
  <content><![CDATA[
    <event settedUpInitially="true">
      <condition><timer timeout="#{timeout}" forceDropOnTimeout="false"/></condition>
      <triggers>#{trigger}<success/></triggers>
    </event>
  ]]></content>
</template>
<template name="set-object-warzone">
  <params>
    <param name="objectId"/>
    <param name="regionId"/>
    <param name="objectPoint" default="all"/>
    <param name="message"/>
    <param name="trigger" default=""/>
  </params>
  <content><![CDATA[
    <event settedUpInitially="true">
      <condition><not>
        <inside objectId="#{objectId}" regionId="#{regionId}" objectPoint="#{objectPoint}"/>
      </not></condition>
      <triggers>#{trigger}<message text="#{message}"/><success/></triggers>
    </event>
  ]]></content>
</template>
<template name="set-robot-warzone">
  <params>
    <param name="regionId"/>
    <param name="objectPoint" default="all"/>
    <param name="message" default="The robot has moved out of a valid region"/>
    <param name="trigger" default=""/>
  </params>
  <content><![CDATA[
    <use template="set-object-warzone" objectId="robot1" regionId="#{regionId}"
         objectPoint="#{objectPoint}" message="#{message}">
      <with param="trigger">#{trigger}</with>
    </use>
  ]]></content>
</template>
<template name="change-score-with-log">
  <params>
    <param name="id"/>
    <param name="settedUpInit" default="true"/>
    <param name="conditions"/>
    <param name="scoreVariable" default="total_score"/>
    <param name="operation" default="sum"/>
    <param name="variable"/>
    <param name="message" default="Points scored: ${#{scoreVariable}}"/>
    <param name="trigger" default=""/>
  </params>
  <content><![CDATA[
    <use template="condition-event" id="#{id}" settedUpInit="#{settedUpInit}">
      <with param="conditions">#{conditions}</with>
      <with param="trigger">
        <setter name="#{scoreVariable}">
          <#{operation}>
            <variableValue name="#{scoreVariable}"/><variableValue name="#{variable}"/>
          </#{operation}>
        </setter>
        <message text="#{message}"/>
        #{trigger}
      </with>
    </use>
  ]]></content>
</template>
<template name="object-in-region-with-score">
  <params>
    <param name="id"/>
    <param name="settedUpInit" default="true"/>
    <param name="objectId" default="robot1"/>
    <param name="regionId"/>
    <param name="objectPoint" default="all"/>
    <param name="scoreVariable" default="total_score"/>
    <param name="operation" default="sum"/>
    <param name="variable"/>
    <param name="message" default="Points scored: ${#{scoreVariable}}"/>
    <param name="trigger" default=""/>
  </params>
  <content><![CDATA[
    <use template="change-score-with-log" id="#{id}" settedUpInit="#{settedUpInit}"
         scoreVariable="#{scoreVariable}" operation="#{operation}" variable="#{variable}"
         message="#{message}">
      <with param="conditions">
        <inside objectId="#{objectId}" regionId="#{regionId}" objectPoint="#{objectPoint}"/>
      </with>
      <with param="trigger">#{trigger}</with>
    </use>
  ]]></content>
</template>
<template name="object-region-with-score">
  <params>
    <param name="id"/>
    <param name="settedUpInit" default="true"/>
    <param name="objectId" default="robot1"/>
    <param name="regionId"/>
    <param name="objectPoint" default="all"/>
    <param name="scoreVariable" default="total_score"/>
    <param name="operation" default="sum"/>
    <param name="variable"/>
    <param name="message" default="Points scored: ${#{scoreVariable}}"/>
    <param name="trigger" default=""/>
  </params>
  <content><![CDATA[
    <use template="object-in-region-with-score" id="#{id}" settedUpInit="#{settedUpInit}"
         objectId="#{objectId}" regionId="#{regionId}" objectPoint="#{objectPoint}"
         scoreVariable="#{scoreVariable}" operation="#{operation}" variable="#{variable}"
         message="#{message}">
      <with param="trigger">#{trigger}</with>
    </use>
  ]]></content>
</template>
<template name="object-left-region-with-score">
  <params>
    <param name="id"/>
    <param name="settedUpInit" default="true"/>
    <param name="objectId" default="robot1"/>
    <param name="regionId"/>
    <param name="objectPoint" default="any"/>
    <param name="scoreVariable" default="total_score"/>
    <param name="operation" default="sum"/>
    <param name="variable"/>
    <param name="message" default="Points scored: ${#{scoreVariable}}"/>
    <param name="trigger" default=""/>
  </params>
  <content><![CDATA[
    <use template="change-score-with-log" id="#{id}" settedUpInit="#{settedUpInit}"
         scoreVariable="#{scoreVariable}" operation="#{operation}" variable="#{variable}"
         message="#{message}">
      <with param="conditions"><not>
        <inside objectId="#{objectId}" regionId="#{regionId}" objectPoint="#{objectPoint}"/>
      </not></with>
      <with param="trigger">#{trigger}</with>
    </use>
  ]]></content>
</template>
<template name="robot-stop-in-region-with-score">
  <params>
    <param name="id"/>
    <param name="settedUpInit" default="true"/>
    <param name="regionId"/>
    <param name="objectPoint" default="all"/>
    <param name="scoreVariable" default="total_score"/>
    <param name="operation" default="sum"/>
    <param name="variable"/>
    <param name="message" default="Points scored: ${#{scoreVariable}}"/>
    <param name="trigger" default=""/>
  </params>
  <content><![CDATA[
    <use template="change-score-with-log" id="#{id}" settedUpInit="#{settedUpInit}"
         scoreVariable="#{scoreVariable}" operation="#{operation}" variable="#{variable}"
         message="#{message}">
      <with param="conditions">
        <inside objectId="robot1" regionId="#{regionId}" objectPoint="#{objectPoint}"/>
        <equals _1="${robot1.isRiding}" _2="false"/>
      </with>
      <with param="trigger">#{trigger}</with>
    </use>
  ]]></content>
</template>
<template name="robot-finish-in-region-with-score">
  <params>
    <param name="id"/>
    <param name="settedUpInit" default="true"/>
    <param name="regionId"/>
    <param name="objectPoint" default="all"/>
    <param name="scoreVariable" default="total_score"/>
    <param name="operation" default="sum"/>
    <param name="variable"/>
    <param name="message" default="Points scored: ${#{scoreVariable}}"/>
    <param name="trigger" default=""/>
  </params>
  <content><![CDATA[
    <use template="robot-stop-in-region-with-score" id="#{id}" settedUpInit="#{settedUpInit}"
         regionId="#{regionId}" objectPoint="#{objectPoint}"
         scoreVariable="#{scoreVariable}" operation="#{operation}" variable="#{variable}"
         message="#{message}">
      <with param="trigger">#{trigger}<success/></with>
    </use>
  ]]></content>
</template>
<template name="robot-start-with-score">
  <params>
    <param name="id"/>
    <param name="settedUpInit" default="true"/>
    <param name="scoreVariable" default="total_score"/>
    <param name="operation" default="sum"/>
    <param name="variable"/>
    <param name="message" default="Points scored: ${#{scoreVariable}}"/>
    <param name="trigger" default=""/>
  </params>
  <content><![CDATA[
    <use template="change-score-with-log" id="#{id}" settedUpInit="#{settedUpInit}"
         scoreVariable="#{scoreVariable}" operation="#{operation}" variable="#{variable}"
         message="#{message}">
      <with param="conditions"><equals _1="${robot1.isRiding}" _2="true"/></with>
      <with param="trigger">#{trigger}</with>
    </use>
  ]]></content>
</template>
<template name="robot-start">
  <params>
    <param name="regionId"/>
    <param name="objectPoint" default="all"/>
    <param name="message" default="The robot must be in the start region at the start"/>
  </params>
  <content><![CDATA[
    <constraint checkOnce="true" failMessage="#{message}">
      <inside objectId="robot1" regionId="#{regionId}" objectPoint="#{objectPoint}"/>
    </constraint>
  ]]></content>
</template>
<template name="robot-stop">
  <params>
    <param name="id" default="robot-stop"/>
    <param name="settedUpInit" default="true"/>
    <param name="regionId"/>
    <param name="objectPoint" default="all"/>
    <param name="trigger" default=""/>
  </params>
  <content><![CDATA[
    <use template="condition-event" id="#{id}" settedUpInit="#{settedUpInit}">
      <with param="conditions">
        <inside objectId="robot1" regionId="#{regionId}" objectPoint="#{objectPoint}"/>
        <equals _1="${robot1.isRiding}" _2="false"/>
      </with>
      <with param="trigger">#{trigger}<success/></with>
    </use>
  ]]></content>
</template>
<template name="is-undefined">
  <params><param name="objectId"/></params>
  <content><![CDATA[
    <equals><typeOf objectId="#{objectId}"/><string value="undefined"/></equals>
  ]]></content>
</template>
<template name="typeof">
  <params><param name="objectId"/><param name="type"/></params>
  <content><![CDATA[
    <equals><typeOf objectId="#{objectId}"/><string value="#{type}"/></equals>
  ]]></content>
</template>
</templates>"##;
